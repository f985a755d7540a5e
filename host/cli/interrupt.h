// SPDX-License-Identifier: MIT
#pragma once

#include <string>

// Signals end a run as errors do: with its cleaning-up, and 128 + the signal as exit code.
namespace topple::cli {

// From here on SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGPIPE and SIGXCPU remove what is unfinished and
// end the program. A hang-up that whoever started the program ignores (nohup) stays ignored.
void end_on_signals();

// From here on a first signal is only noted, for a long run that polls; who signals again ends the
// program at once. Not so SIGPIPE, which comes with each line that nobody reads.
void catch_interrupts();

// The signal that came, or 0. For long runs to poll.
int interrupted();

// Says that the run was interrupted and what it left, if anything, and returns the exit code for
// it.
int interrupted_exit(const std::string& left = {});

}  // namespace topple::cli
