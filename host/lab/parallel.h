// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "core/thread_pool.h"

namespace topple::scenes {

// body(first, last) over equal pieces of [0, count), one for each thread (0: core), and waits for
// them all. The pieces' borders depend on the number of threads: a result must not.
template <class Body>
void in_parallel(std::size_t count, const Body& body, std::size_t threads = 0) {
    ThreadPool pool(static_cast<unsigned>(threads));
    threads = pool.threads();
    pool.each(threads, 1,
              [&](std::size_t n) { body(count * n / threads, count * (n + 1) / threads); });
}

}  // namespace topple::scenes
