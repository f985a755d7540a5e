// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

namespace topple::child {

// What a process may open from then on: these files, and all in these folders.
struct Reach {
    std::vector<std::filesystem::path> read, write;  // write: folders, to make files in
};

// Called in a process that reads what strangers made, before it does, while it has one thread: so
// that nobody who takes it over by a fault in a library gets further. Gives up, for good, all other
// files (Landlock: Linux 5.13) and the net, other programs, processes and more of the kernel that
// no reader needs (seccomp). What the kernel does not have is left as it is.
void confine(const Reach& reach);

// Ends this process with the one that started it, which has this id.
void end_with(long parent);

}  // namespace topple::child
