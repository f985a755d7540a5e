// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

// The list behind remove_pending_outputs(). It is the one piece of state of the library that is not
// owned by an object: a signal handler has no other way to find what to remove.
namespace topple::io {

// In a staging folder the file that its owner has locked; it goes last.
inline constexpr const char* staging_lock = "lock";

// Notes that `folder` and its `parents` innermost parents go if the program is interrupted. Returns
// a slot for forget_pending(), or -1 where the list is full or the path too long: then an
// interrupted run leaves its staging folder behind for the next one to remove.
int add_pending(const std::filesystem::path& folder, int parents) noexcept;
void forget_pending(int slot) noexcept;

// Removes a folder with all in it, no link followed. Async-signal-safe.
void remove_tree(const char* path) noexcept;

// Removes the staging folders of all that is being written, for a program that is about to end by a
// signal. It is async-signal-safe: call it in the handler, then _exit(). It uses system calls on
// memory of its own only, so it is right whatever the interrupted thread was doing.
void remove_pending_outputs() noexcept;

}  // namespace topple::io
