// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace topple::child {

// NAME=VALUE, of what a program of ours needs to start and to be tested: nothing that loads or runs
// anything else.
std::vector<std::string> plain_environment();

// Where a program lies in the folders of PATH: absolute ones, as any other name is of the current
// folder, which may be a stranger's. Empty: in none.
std::string found_in_path(const std::string& name);

}  // namespace topple::child
