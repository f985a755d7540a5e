// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <ctime>

namespace topple::perf {

// Wall time, and the time that all threads of this process spent on a core: what other processes
// take away shows in the first only. What a GPU does shows in the first only, too.
struct Span {
    double wall_s = 0, cpu_s = 0;
};

class Stopwatch {
  public:
    Stopwatch() : start_(now()) {}
    Span elapsed() const {
        const Span end = now();
        return {end.wall_s - start_.wall_s, end.cpu_s - start_.cpu_s};
    }

  private:
    static Span now() {
        timespec cpu{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
        const auto wall = std::chrono::steady_clock::now().time_since_epoch();
        return {std::chrono::duration<double>(wall).count(),
                static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec)};
    }
    Span start_;
};

}  // namespace topple::perf
