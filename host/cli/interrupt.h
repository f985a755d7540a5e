// SPDX-License-Identifier: MIT
#pragma once

#include <string>

// SIGINT and SIGTERM end a long run as errors do: with its cleaning-up.
namespace topple::cli {

// From here on a first signal is only noted; who signals again ends the program at once, its
// unfinished outputs removed.
void catch_interrupts();

// The signal that came, or 0. For long runs to poll.
int interrupted();

// Says that the run was interrupted and what it left, if anything, and returns the exit code for
// it.
int interrupted_exit(const std::string& left = {});

}  // namespace topple::cli
