// SPDX-License-Identifier: MIT
// topple-lab: makes rooms and judges parses of them. `topple generate`, `topple evaluate` and
// `topple rate` run it in their place, with the arguments that they got.
#include <csignal>

#include "cli/command_line.h"
#include "cli/main/freed_memory.h"
#include "lab/commands/commands.h"

int main(int argc, char** argv) {
    using namespace topple::cli;
    keep_freed_memory();
    std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit (ulimit -f) is an error of its write
    const CommandEntry commands[] = {{"generate", generate_purpose, add_generate},
                                     {"evaluate", evaluate_purpose, add_evaluate},
                                     {"rate", rate_purpose, add_rate}};
    return run_command_line(commands, argc, argv, print_error);
}
