// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "testing.h"

namespace topple::exports::test {

inline constexpr int script_missing = 77;  // a library of the script's is not installed

// What a script of this folder prints, and how it ends; not installed is missing only where nothing
// requires it.
inline std::pair<std::string, int> run_script(const std::string& name,
                                              const std::string& argument) {
    std::string command = TOPPLE_TEST_PYTHON " -B " TOPPLE_SOURCE_DIR "/tests/simulators/";
    command += name + " " + argument + " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return {"no pipe", -1};
    std::string out(1 << 20, '\0');
    out.resize(fread(out.data(), 1, out.size(), pipe));
    const int status = pclose(pipe);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    const char* required = std::getenv("TOPPLE_REQUIRE_BACKENDS");
    const bool needed = required && std::string(required) == "1";
    if (code == 127) return {out, needed ? code : script_missing};
    return {out, code == script_missing && needed ? -1 : code};
}

// Has the script NAME_check.py judge cases: prints what it says, and fails where it does.
inline void judge_by_script(const std::string& name, const nlohmann::json& cases) {
    const auto file = std::filesystem::temp_directory_path() / ("topple-" + name + ".json");
    std::ofstream(file) << cases;
    const auto [text, code] = run_script(name + "_check.py", file.string());
    if (code == script_missing) GTEST_SKIP() << text << "run ./dev setup";
    std::printf("%s", text.c_str());
    EXPECT_EQ(code, 0) << text;
}

}  // namespace topple::exports::test
