// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <span>

#include "cli/commands.h"
#include "topple/error.h"

// Programs that consist of commands.
namespace topple::cli {

struct CommandEntry {
    const char* name;
    const char* what;  // it does, for the help
    std::function<Command(CLI::App&)> define;
};

int exit_code(ErrorKind kind);

// On stderr, as one line.
void print_error(const Error& error);

// The same that memory ran out, which takes none.
void print_out_of_memory() noexcept;

// Runs the command that the arguments name, and returns the program's exit code. Whatever is wrong
// with the arguments, or comes out of the command, is told by `tell`.
int run_command_line(std::span<const CommandEntry> commands, int argc, char** argv,
                     const std::function<void(const Error&)>& tell);

}  // namespace topple::cli
