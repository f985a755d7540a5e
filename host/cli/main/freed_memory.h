// SPDX-License-Identifier: MIT
#pragma once

#include <malloc.h>

#include <algorithm>
#include <climits>
#include <thread>

namespace topple::cli {

// Stages take and leave hundreds of megabytes: handed back to the system and taken again, each page
// is a fault and filled with zeros, up to a tenth of a parse's processor time. So freed memory is
// kept, large blocks come from it, too, and arenas, which keep theirs each by itself, are few.
inline void keep_freed_memory() {
#ifdef __GLIBC__
    ::mallopt(M_MMAP_MAX, 0);
    ::mallopt(M_TRIM_THRESHOLD, INT_MAX);
    ::mallopt(M_ARENA_MAX, std::max(1, static_cast<int>(std::thread::hardware_concurrency() / 2)));
#endif
}

}  // namespace topple::cli
