// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>

#include "simulators/exported.h"
#include "simulators/script.h"

// What libraries for Python make of exports: each has a script of its own in this folder.
namespace topple::exports::test {
namespace {

void check_by(const std::string& library) {
    for (const Exported& each : exported()) {
        const auto [text, code] = run_script(library + "_check.py", each.folder.string());
        if (code == script_missing) GTEST_SKIP() << text << "run ./dev setup";
        EXPECT_EQ(code, 0) << text;
        EXPECT_NE(text.find(library + " has read all"), std::string::npos) << text;
    }
}

TEST(Exports, AreReadAndRunByMujoco) {
    check_by("mujoco");
}
TEST(Exports, AreReadAndRunByPybullet) {
    check_by("pybullet");
}
TEST(Exports, AreReadByUsd) {
    check_by("usd");
}

}  // namespace
}  // namespace topple::exports::test
