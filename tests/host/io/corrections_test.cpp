// SPDX-License-Identifier: MIT
#include "topple/corrections.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "files.h"

namespace topple {
namespace {

using Kind = Correction::Kind;

std::string file_of(const std::string& entries) {
    return R"({"schema": "topple.corrections/1", "corrections": [)" + entries + "]}";
}

class Corrections : public test::Files {
  protected:
    void refused(const std::string& text, std::initializer_list<std::string_view> parts) {
        const auto file = write("corrections.json", text);
        test::expect_input_error([&] { read_corrections(file); }, {file.native()});
        test::expect_input_error([&] { read_corrections(file); }, parts);
        test::expect_input_error([&] { corrections_of(text); }, parts);
    }
};

TEST_F(Corrections, OfEachKind) {
    const auto all = read_corrections(write("corrections.json", "\xEF\xBB\xBF" + file_of(R"(
        {"do": "one_thing", "at_m": [[1, 2, 3], [4.5, 0, -1e-1]]},
        {"do": "apart", "at_m": [[1, 2, 3]], "from_m": [[0, 0, 0], [1, 1, 1]]},
        {"do": "fixed", "at_m": [[1, 2, 3]], "said_by": "me", "was": "object 16"},
        {"do": "not_there", "at_m": [[1, 2, 3]]},
        {"do": "hollow", "at_m": [[1, 2, 3]], "wall_m": 0.02},
        {"do": "mass", "at_m": [[1, 2, 3]], "kg": 12},
        {"name": "K\u00fchlschrank", "at_m": [[1, 2, 3]], "do": "name"})")));
    ASSERT_EQ(all.size(), 7u);
    for (std::size_t n = 0; n < all.size(); ++n) {
        EXPECT_EQ(all[n].kind, static_cast<Kind>(n));
        EXPECT_EQ(all[n].at_m.front(), (Vec3{1, 2, 3}));
    }
    EXPECT_EQ(all[0].at_m[1], (Vec3{4.5, 0, -0.1}));
    EXPECT_EQ(all[1].from_m.size(), 2u);
    EXPECT_EQ(all[4].wall_m, 0.02);
    EXPECT_EQ(all[5].mass_kg, 12);
    EXPECT_EQ(all[2].was, "object 16");
    EXPECT_EQ(all[6].name, "K\u00fchlschrank");
    EXPECT_FALSE(fault_of(all));
    EXPECT_TRUE(corrections_of(file_of("")).empty());
}

TEST_F(Corrections, FilesThatAreNone) {
    refused("", {});
    refused("[]", {"schema", "topple.corrections/1"});
    refused("{", {"is no JSON"});
    refused(R"({"corrections": []})", {"schema"});
    refused(R"({"schema": "topple.scene/1", "corrections": []})", {"schema"});
    refused(R"({"schema": 1, "corrections": []})", {"schema"});
    refused(R"({"schema": "topple.corrections/1"})", {"no list \"corrections\""});
    refused(R"({"schema": "topple.corrections/1", "corrections": {}})", {"no list"});
    refused(std::string(200'000, '['), {"nested"});
    refused(file_of(R"({"do": "fixed", "at_m": [[1e999, 0, 0]]})"), {});
    refused(file_of(R"({"do": "fixed", "at_m": [[0, 0, 0]], "was": 16})"), {"was", "text is due"});
    refused(file_of(R"({"do": "fixed", "at_m": [[0, 0, 0]], "was": "a\nb"})"),
            {"\"was\"", "control character"});
    const std::string fixed = R"({"do": "fixed", "at_m": [[0, 0, 0]]})";
    std::string many = fixed;
    for (int n = 0; n < 1000; ++n) many += "," + fixed;
    refused(file_of(many), {"1001", "limit of 1000"});
    test::expect_input_error([&] { read_corrections(write("huge", std::string(10'000'001, ' '))); },
                             {"huge"});
    test::expect_input_error([&] { read_corrections(path("none")); }, {"none"});
}

TEST_F(Corrections, EntriesThatSayNothing) {
    const std::string good = R"({"do": "fixed", "at_m": [[0, 0, 0]]}, )";
    const auto wrong = [&](const std::string& entry,
                           std::initializer_list<std::string_view> parts) {
        SCOPED_TRACE(entry);
        refused(file_of(good + entry), {"correction 2"});
        refused(file_of(good + entry), parts);
    };
    wrong("7", {"number"});
    wrong("{}", {"\"do\""});
    wrong(R"({"do": 3})", {"\"do\"", "text"});
    wrong(R"({"do": "glue", "at_m": [[0, 0, 0]]})", {"glue", "one_thing", "name"});
    wrong(R"({"do": "fixed"})", {"(fixed)", "no \"at_m\""});
    for (const char* spots : {"3", "[]", "[3]", "[[0, 0]]", "[[0, 0, 0, 0]]", "[[0, 0, \"1\"]]",
                              "[[0, 0, null]]", "{\"a\": [0, 0, 0]}"})
        wrong(std::string(R"({"do": "fixed", "at_m": )") + spots + "}", {"(fixed)", "\"at_m\""});
    wrong(R"({"do": "fixed", "at_m": [[0, 0, 1e300]]})", {"spot 1", "1e+300"});
    wrong(R"({"do": "one_thing", "at_m": [[0, 0, 1]]})", {"1 spot", "2 spots"});
    wrong(R"({"do": "apart", "at_m": [[0, 0, 1]]})", {"no \"from_m\""});
    wrong(R"({"do": "apart", "at_m": [[0, 0, 1]], "from_m": []})", {"from_m", "0 spots"});
    wrong(R"({"do": "hollow", "at_m": [[0, 0, 1]]})", {"no \"wall_m\""});
    wrong(R"({"do": "hollow", "at_m": [[0, 0, 1]], "wall_m": "0.02"})", {"wall_m", "number"});
    wrong(R"({"do": "hollow", "at_m": [[0, 0, 1]], "wall_m": 0})", {"wall_m", "above 0"});
    wrong(R"({"do": "mass", "at_m": [[0, 0, 1]], "kg": -1})", {"kg", "-1"});
    wrong(R"({"do": "mass", "at_m": [[0, 0, 1]], "kg": 1e12})", {"kg", "1e+06"});
    wrong(R"({"do": "name", "at_m": [[0, 0, 1]], "name": " "})", {"name", "empty"});
    wrong(R"({"do": "name", "at_m": [[0, 0, 1]], "name": "a\nb"})", {"name", "control"});
    wrong(R"({"do": "name", "at_m": [[0, 0, 1]], "name": ")" + std::string(201, 'x') + "\"}",
          {"name", "201"});
    std::string spots = "[0, 0, 0]";
    for (int n = 0; n < 100; ++n) spots += ", [0, 0, 0]";
    wrong(R"({"do": "fixed", "at_m": [)" + spots + "]}", {"101", "limit of 100"});
}

// Programs may say what no file can.
TEST(CorrectionsInMemory, AreCheckedToo) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Correction mass{Kind::mass, {{0, 0, 0}}, {}, 0, 1, ""};
    EXPECT_FALSE(fault_of({mass}));
    mass.mass_kg = nan;
    EXPECT_EQ(fault_of({mass}).value_or("").find("correction 1 (mass): mass_kg is nan kg"), 0u);
    const Correction fixed{Kind::fixed, {{0, nan, 0}}, {}, 0, 0, ""};
    EXPECT_NE(fault_of({fixed, fixed}).value_or("").find("correction 1 (fixed)"),
              std::string::npos);
    const Correction apart{Kind::apart, {{0, 0, 0}}, {}, 0, 0, ""};
    EXPECT_TRUE(fault_of({apart}));
}

}  // namespace
}  // namespace topple
