// SPDX-License-Identifier: MIT
#include <malloc.h>

#include <algorithm>
#include <climits>
#include <csignal>
#include <thread>

#include "cli/command_line.h"
#include "cli/commands.h"

namespace {

// Stages take and leave hundreds of megabytes: handed back to the system and taken again, each page
// is a fault and filled with zeros, up to a tenth of a parse's processor time. So freed memory is
// kept, large blocks come from it, too, and arenas, which keep theirs each by itself, are few.
void keep_freed_memory() {
#ifdef __GLIBC__
    ::mallopt(M_MMAP_MAX, 0);
    ::mallopt(M_TRIM_THRESHOLD, INT_MAX);
    ::mallopt(M_ARENA_MAX, std::max(1, static_cast<int>(std::thread::hardware_concurrency() / 2)));
#endif
}

}  // namespace

int main(int argc, char** argv) {
    using namespace topple::cli;
    keep_freed_memory();
    std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit (ulimit -f) is an error of its write
    const CommandEntry commands[] = {
        {"parse", parse_purpose,
         [&](CLI::App& app) {
             return add_parse(app, {argv, argv + argc});
         }},
        {"estimate", "Say what memory, disk and time a parse would take", add_estimate},
        {"landscape", "Draw the energy landscapes of an object that a parse has found",
         add_landscape},
        {"export", "Make a scene for simulators of what a parse has found", add_export},
        {"verify", "Run what a parse has found in MuJoCo, and say what stays where it is",
         add_verify},
        {"view", "Show what a parse has found in the browser", add_view},
        {"devices", "List every device of every backend, or why one is missing", add_devices},
        {"generate", "Make a scan of a furnished room, with its ground truth", add_generate},
        {"evaluate", "Parse generated rooms and judge the results against the truth", add_evaluate},
        {"perf", "Measure every kernel, stage and parse on every backend", add_perf}};
    return run_command_line(commands, argc, argv, print_error);
}
