// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

namespace topple::cli {

// The first of `words` that looks like an option (--name or --name=value) and is none of `app`'s,
// with the nearest one that is, as in "unknown option --wnd; did you mean --wind?". Empty where all
// are known: the parser takes the value of an unknown option for an argument, and complains of that
// one or of another.
std::string unknown_option(const CLI::App& app, std::span<const char* const> words);

// The same of the first of `words` after the program's name, if that is none of `app`'s
// subcommands: 'unknown subcommand "prase"; did you mean parse?'. Empty where it is an option.
std::string unknown_command(const CLI::App& app, std::span<const char* const> words);

}  // namespace topple::cli
