// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

namespace topple::scenes {

// body(first, last) over equal pieces of [0, count), one for each thread (0: core), and waits for
// them all. The pieces' borders depend on the number of threads: a result must not.
template <class Body>
void in_parallel(std::size_t count, const Body& body, std::size_t threads = 0) {
    if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::jthread> running;
    for (std::size_t n = 1; n < threads; ++n) {
        running.emplace_back(
            [&body, count, threads, n] { body(count * n / threads, count * (n + 1) / threads); });
    }
    body(0, count / threads);
}

}  // namespace topple::scenes
