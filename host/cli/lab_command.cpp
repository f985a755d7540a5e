// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include "child/program.h"
#include "cli/commands.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

constexpr const char* lab_program = "topple-lab";

}  // namespace

Command add_lab(CLI::App& app, char** argv) {
    app.set_help_flag();  // topple-lab has it, and the options
    app.set_help_all_flag();
    app.prefix_command();
    return [argv]() -> int {
        const std::filesystem::path program = child::find_program(lab_program);
        if (program.empty())
            throw Error(ErrorKind::usage,
                        std::string(lab_program) +
                            " was not found beside topple: build the target topple-lab, or install "
                            "topple again, which puts it into libexec/topple");
        ::execv(program.c_str(), argv);
        throw Error(ErrorKind::usage, program.string() + ": " + std::strerror(errno));
    };
}

}  // namespace topple::cli
