// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "files.h"
#include "topple/input.h"

namespace topple {
namespace {

class HazardCurves : public test::Files {
  protected:
    HazardCurve hazard(std::string_view bytes) { return read_hazard_curve(write("hazard", bytes)); }
};

TEST_F(HazardCurves, OfLinesAndOfJson) {
    const std::vector<double> peaks{0.05, 0.2, 1}, rates{0.02, 0.002, 0.0001};
    for (const char* text :
         {"0.05 0.02\n0.2 0.002\n1 1e-4\n", "pga_g,per_year\n0.05,0.02\n0.2,0.002\n1,1e-4",
          "# site 7\nPGA rate\r\n0.05\t0.02\r\n\r\n0.2 0.002 # a note\r\n1 1e-4\r\n",
          R"({"per_year": [0.02, 0.002, 0.0001], "pga_g": [0.05, 0.2, 1], "site": "7"})"}) {
        const HazardCurve curve = hazard(text);
        EXPECT_EQ(curve.pga_g, peaks) << text;
        EXPECT_EQ(curve.per_year, rates) << text;
        EXPECT_FALSE(curve.fault());
    }
}

TEST_F(HazardCurves, WhatIsNone) {
    const test::BadFile cases[] = {
        {"0.05 0.02\n", {"at least 2"}},
        {"only words\n", {"at least 2"}},
        {"0.05 0.02\n0.2\n", {"line 2"}},
        {"0.05 0.02\nmore 3\n", {"line 2"}},
        {"0.2 0.02\n0.1 0.002\n", {"point 2", "rise"}},
        {"0.1 0.02\n0.2 0.03\n", {"point 2", "fall"}},
        {"0 0.02\n0.2 0.01\n", {"point 1", "above 0"}},
        {"0.1 0.02\n50 0.01\n", {"point 2", "10 g"}},
        {"0.1 nan\n0.2 0.01\n", {"point 1"}},
        {R"({"pga_g": [0.1, 0.2]})", {"per_year"}},
        {R"({"pga_g": [0.1, 0.2], "per_year": [0.1]})", {"2 peaks", "1 rate"}},
        {R"({"pga_g": [0.1, "0.2"], "per_year": [0.1, 0.01]})", {"pga_g", "string"}},
        {R"({"pga_g": [0.1)", {"line 1"}},
    };
    expect_refused("hazard", cases, [](const auto& file) { read_hazard_curve(file); });
    test::expect_input_error([] { read_hazard_curve("/no/such/file"); }, {"/no/such/file"});
}

}  // namespace
}  // namespace topple
