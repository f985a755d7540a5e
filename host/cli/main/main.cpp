// SPDX-License-Identifier: MIT
#include <csignal>

#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/main/freed_memory.h"

int main(int argc, char** argv) {
    using namespace topple::cli;
    keep_freed_memory();
    std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit (ulimit -f) is an error of its write
    const auto lab = [&](CLI::App& app) { return add_lab(app, argv); };
    const CommandEntry commands[] = {
        {"parse", parse_purpose,
         [&](CLI::App& app) {
             return add_parse(app, {argv, argv + argc});
         }},
        {"estimate", "Say what memory, disk and time a parse would take", add_estimate},
        {"landscape", "Draw the energy landscapes of an object that a parse has found",
         add_landscape},
        {"ask", "Say what falls without an object, what has to go first, what holds it", add_ask},
        {"export", "Make a scene for simulators of what a parse has found", add_export},
        {"verify", "Run what a parse has found in MuJoCo, and say what stays where it is",
         add_verify},
        {"view", "Show what a parse has found in the browser", add_view},
        {"live", "Follow a scan that is still being made: what is there, came and has gone",
         add_live},
        {"compare", "Say what came, went and moved between two parses of one room", add_compare},
        {"devices", "List every device of every backend, or why one is missing", add_devices},
        {"generate", generate_purpose, lab},
        {"evaluate", evaluate_purpose, lab},
        {"rate", rate_purpose, lab},
        {"perf", "Measure every kernel, stage and parse on every backend", add_perf}};
    return run_command_line(commands, argc, argv, print_error);
}
