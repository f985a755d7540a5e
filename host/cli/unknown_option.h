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

// What to say where a value was written with a space in it, so that its end was taken for an
// argument: a list after a comma, a number before its unit, or a title of several words. 'write the
// list without spaces: human,earthquake'; empty where there is none.
std::string value_with_space(std::span<const char* const> words);

}  // namespace topple::cli
