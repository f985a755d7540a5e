// SPDX-License-Identifier: MIT
#include "cli/command_line.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <map>
#include <new>
#include <span>
#include <string>
#include <string_view>

#include "cli/further_options.h"
#include "cli/interrupt.h"
#include "cli/print.h"
#include "cli/shared_options.h"
#include "cli/unknown_option.h"
#include "core/short_number.h"
#include "io/text.h"
#include "topple/version.h"

namespace topple::cli {
namespace {

Error wrong_usage(const std::string& what) {
    return {ErrorKind::usage, what + " (see topple --help)"};
}

// Of a value with a unit of length behind its number what to give in its place.
std::string in_metres(const std::string& value) {
    double number = 0;
    for (const auto& [unit, metres] : units_of_length())
        if (value.ends_with(unit) &&
            io::parse_number(value.substr(0, value.size() - unit.size()), number))
            return " without its unit: lengths are in metres, here " +
                   short_number(number * metres);
    return {};
}

// An empty value, as an unset variable of a script leaves it, is none: the library takes it for the
// default.
void check_values(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& value : option->results()) {
            if (value.empty())
                throw wrong_usage(option->get_name() +
                                  ": its value is empty; leave it out for the default");
        }
    }
}

// Where one of the standard descriptors is closed the next file would get its number, and with it
// what is printed. What stands in its place can't be written, or read.
void open_standard_files() {
    for (const int fd : {0, 1, 2})
        if (::fcntl(fd, F_GETFD) < 0) ::open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
}

// What was printed may have gone nowhere, as on a full disk.
int with_output_written(int code) {
    errno = 0;
    if (code != 0 || (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)) return code;
    if (interrupted() == SIGPIPE) return 128 + SIGPIPE;
    throw Error(ErrorKind::input, std::string("standard output can't be written: ") +
                                      (errno != 0 ? std::strerror(errno) : "it is full or closed"));
}

int run(std::span<const CommandEntry> entries, int argc, char** argv) {
    CLI::App app{
        "topple tells which things in a 3D scan of a room are one solid object, what holds what "
        "up,\n"
        "and what may fall: when someone walks by, in wind, in an earthquake."};
    app.set_help_flag("-h,--help", "Print this help and exit");
    app.set_help_all_flag("--help-all", "Print it with all options and exit");
    list_them_apart(app);
    app.set_version_flag("--version", std::string("topple ") + version);
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 done; 1 the input can't be parsed, or the output can't be written; 2 wrong "
        "usage;\n"
        "3 the asked-for backend or device can't be used; 130 stopped by Ctrl-C, 143 by SIGTERM,\n"
        "128 + N by another signal N.");
    std::map<const CLI::App*, Command> commands;
    for (const CommandEntry& entry : entries) {
        CLI::App* sub = app.add_subcommand(entry.name, entry.what);
        commands[sub] = entry.define(*sub);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& done) {
        const auto chosen = app.get_subcommands();
        if (!chosen.empty() && chosen.front()->get_prefix_command())
            return commands.at(chosen.front())();  // whose help another program has
        return app.exit(done);
    } catch (const CLI::ConversionError& error) {
        // "Could not convert: --wind-from = abc"
        std::string what = error.what();
        const auto from = what.find("--"), is = what.find(" = ");
        if (from != std::string::npos && is != std::string::npos && from < is) {
            const std::string value = what.substr(is + 3);
            what = what.substr(from, is - from) + " " + value + ": expected a number" +
                   in_metres(value);
        }
        throw wrong_usage(what);
    } catch (const CLI::ValidationError& error) {
        // "--unit: feet: expected m or cm", of which the first part is the parser's.
        std::string what = error.what();
        const auto name = what.find(": "), expected = what.find(": expected ");
        if (name < expected && expected != std::string::npos) what.erase(name, 1);
        throw wrong_usage(what);
    } catch (const CLI::ParseError& error) {
        const auto subcommands = app.get_subcommands();
        const std::span<const char* const> words(argv, static_cast<std::size_t>(argc));
        std::string unknown = subcommands.empty() ? unknown_command(app, words) : "";
        if (unknown.empty())
            unknown = unknown_option(subcommands.empty() ? app : *subcommands.front(), words);
        if (!unknown.empty()) throw wrong_usage(unknown);
        const std::string mend = value_with_space(words);
        throw wrong_usage(error.what() + (mend.empty() ? mend : "; " + mend));
    }
    const CLI::App& chosen = *app.get_subcommands().front();
    check_values(chosen);
    return commands.at(&chosen)();
}

constexpr const char* out_of_memory_text =
    "out of memory; use a larger --voxel, or allow more with --max-memory where there is more";

}  // namespace

int exit_code(ErrorKind kind) {
    return kind == ErrorKind::usage ? 2 : kind == ErrorKind::device ? 3 : 1;
}

void print_error(const Error& error) {
    print_to(stderr, "topple: %s\n", error.what());
}

void print_out_of_memory() noexcept {
    for (const std::string_view part : {"topple: ", out_of_memory_text, "\n"})
        [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, part.data(), part.size());
}

int run_command_line(std::span<const CommandEntry> commands, int argc, char** argv,
                     const std::function<void(const Error&)>& tell) {
    const auto fail = [&](const Error& error) {
        tell(error);
        return exit_code(error.kind());
    };
    open_standard_files();
    end_on_signals();
    try {
        // Made while there is memory for it.
        const Error out_of_memory(ErrorKind::input, out_of_memory_text);
        try {
            try {
                return with_output_written(run(commands, argc, argv));
            } catch (const Error& error) {
                return fail(error);
            } catch (const std::bad_alloc&) {
                throw;
            } catch (const std::filesystem::filesystem_error& error) {
                return fail(
                    {ErrorKind::input, error.path1().string() + ": " + error.code().message()});
            } catch (const std::exception& error) {
                return fail({ErrorKind::input, error.what()});
            }
        } catch (const std::bad_alloc&) {
            tell(out_of_memory);
            return exit_code(out_of_memory.kind());
        }
    } catch (const std::bad_alloc&) {
        print_out_of_memory();
        return exit_code(ErrorKind::input);
    }
}

}  // namespace topple::cli
