// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

// The list behind remove_pending_outputs(). It is the one piece of state of the library that is not
// owned by an object: a signal handler has no other way to find what to remove.
namespace topple::io {

// Notes that `folder` and its `parents` innermost parents go if the program is interrupted. Returns
// a slot for forget_pending(), or -1 where the list is full or the path too long: then an
// interrupted run leaves its temporary folder behind.
int add_pending(const std::filesystem::path& folder, int parents) noexcept;
void forget_pending(int slot) noexcept;

// Removes the files in a folder, then the folder. Async-signal-safe.
void remove_flat_folder(const char* path) noexcept;

}  // namespace topple::io
