// SPDX-License-Identifier: MIT
#pragma once

#include "fuzz/readers.h"

namespace topple::fuzz {

// Files that topple wrote, and that somebody changed who knows how they are made: each has a right
// checksum. An input is a list of changes to a good file of a small room: eight bytes each.
std::span<const Reader> own_files();

}  // namespace topple::fuzz
