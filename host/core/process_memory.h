// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace topple {

// Of this process, bytes: pages of its own, those that are files' or shared, and what it may use of
// the former without asking again. Zeros where the system does not tell.
struct ProcessMemory {
    std::uint64_t own = 0, of_files = 0, reserved = 0;
};
ProcessMemory process_memory() noexcept;

// What this process may still take without anything being put out: of what the machine has free, of
// its control groups' limits, and of its own (ulimit -v, -d). UINT64_MAX where the system does not
// tell.
std::uint64_t memory_left();

}  // namespace topple
