// SPDX-License-Identifier: MIT
#include <cstdio>
#include <exception>
#include <map>
#include <new>
#include <span>
#include <string>

#include "cli/commands.h"
#include "cli/unknown_option.h"
#include "topple/error.h"
#include "topple/version.h"

namespace {

int exit_code(topple::ErrorKind kind) {
    switch (kind) {
        case topple::ErrorKind::input:
            return 1;
        case topple::ErrorKind::usage:
            return 2;
        case topple::ErrorKind::device:
            return 3;
    }
    return 1;
}

int run(int argc, char** argv) {
    CLI::App app{
        "topple tells which things in a 3D scan of a room are one solid object, what holds what "
        "up,\n"
        "and what may fall: when someone walks by, in wind, in an earthquake."};
    // One help for all: with the options of every command.
    app.set_help_flag();
    app.set_help_all_flag("-h,--help", "Print this help and exit");
    app.set_version_flag("--version", std::string("topple ") + topple::version);
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 done; 1 the input can't be parsed, or the output can't be written; 2 wrong "
        "usage;\n"
        "3 the asked-for backend or device can't be used.");
    std::map<CLI::App*, topple::cli::Command> commands;
    const auto add = [&](const char* name, const char* what, auto define) {
        CLI::App* sub = app.add_subcommand(name, what);
        commands[sub] = define(*sub);
    };
    add("parse", "Parse a scan into solid objects, supports and risks", topple::cli::add_parse);
    add("estimate", "Say what memory, disk and time a parse would take", topple::cli::add_estimate);
    add("landscape", "Draw the energy landscapes of an object that a parse has found",
        topple::cli::add_landscape);
    add("devices", "List every device of every backend, or why one is missing",
        topple::cli::add_devices);
    add("generate", "Make a scan of a furnished room, with its ground truth",
        topple::cli::add_generate);
    add("evaluate", "Parse generated rooms and judge the results against the truth",
        topple::cli::add_evaluate);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& done) {
        return app.exit(done);
    } catch (const CLI::ConversionError& error) {
        // "Could not convert: --wind-from = abc"
        std::string what = error.what();
        const auto from = what.find("--"), is = what.find(" = ");
        if (from != std::string::npos && is != std::string::npos && from < is)
            what = what.substr(from, is - from) + " " + what.substr(is + 3) + ": expected a number";
        std::fprintf(stderr, "topple: %s (see topple --help)\n", what.c_str());
        return 2;
    } catch (const CLI::ParseError& error) {
        const auto subcommands = app.get_subcommands();
        const std::string unknown = topple::cli::unknown_option(
            subcommands.empty() ? app : *subcommands.front(),
            std::span<const char* const>(argv, static_cast<std::size_t>(argc)));
        std::fprintf(stderr, "topple: %s (see topple --help)\n",
                     unknown.empty() ? error.what() : unknown.c_str());
        return 2;
    }
    return commands.at(app.get_subcommands().front())();
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const topple::Error& error) {
        std::fprintf(stderr, "topple: %s\n", error.what());
        return exit_code(error.kind());
    } catch (const std::bad_alloc&) {
        std::fprintf(
            stderr,
            "topple: out of memory; use a larger --voxel or set --max-memory to be told earlier\n");
        return 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "topple: %s\n", error.what());
        return 1;
    }
}
