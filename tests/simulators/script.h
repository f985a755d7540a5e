// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

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

}  // namespace topple::exports::test
