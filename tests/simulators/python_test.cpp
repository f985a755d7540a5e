// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "simulators/exported.h"

// What libraries for Python make of exports: each has a script of its own in this folder.
namespace topple::exports::test {
namespace {

constexpr int missing = 77;  // how a script says that its library is not installed

// What a command prints, and how it ends.
std::pair<std::string, int> run(std::string command) {
    command += " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return {"no pipe", -1};
    std::string out(1 << 20, '\0');
    out.resize(fread(out.data(), 1, out.size(), pipe));
    const int status = pclose(pipe);
    return {out, WIFEXITED(status) ? WEXITSTATUS(status) : -1};
}

void check_by(const std::string& library) {
    for (const Exported& each : exported()) {
        std::string command = TOPPLE_TEST_PYTHON " -B " TOPPLE_SOURCE_DIR "/tests/simulators/";
        command += library + "_check.py " + each.folder.string();
        const auto [text, code] = run(command);
        const char* required = std::getenv("TOPPLE_REQUIRE_BACKENDS");
        if ((code == missing || code == 127) && !(required && std::string(required) == "1"))
            GTEST_SKIP() << text << "run ./dev setup";
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
