// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <numeric>
#include <thread>
#include <vector>

namespace topple {

// A fixed set of threads that share out ranges of an index space. The caller's thread works too.
// Several threads may call at a time, and what runs in a chunk may call again: threads that have
// nothing to do join whichever run was begun last.
class ThreadPool {
  public:
    // More than any machine has use for.
    static constexpr unsigned most_threads = 1024;

    // threads: 0 for one per core; above most_threads that many. Where the system gives fewer, the
    // pool has those that it got, at the least the caller's.
    explicit ThreadPool(unsigned threads);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    unsigned threads() const { return static_cast<unsigned>(workers_.size()) + 1; }

    // Calls body(first, last) for consecutive chunks of [0, count) until all are done. Chunks are
    // handed out in ascending order as threads become free; which thread runs which is not defined.
    // What the body or poll() throws ends the run, once no thread is at a chunk any more: the
    // caller gets the exception of the first chunk that failed, whatever the threads, else poll's.
    void run(std::uint64_t count, std::uint64_t chunk,
             const std::function<void(std::uint64_t, std::uint64_t)>& body);

    // The same with body(i) for each i of [0, count).
    template <class Body>
    void each(std::uint64_t count, std::uint64_t chunk, const Body& body) {
        run(count, chunk, [&](std::uint64_t first, std::uint64_t last) {
            for (std::uint64_t i = first; i < last; ++i) body(static_cast<std::size_t>(i));
        });
    }

    // The same for as many as there are sizes, one at a time, the largest first, of equals the
    // lower: what such a one shares out itself is helped with once the others are done.
    template <class Body>
    void each_largest_first(const std::vector<std::size_t>& sizes, const Body& body) {
        std::vector<std::size_t> order(sizes.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order, std::greater{}, [&](std::size_t i) { return sizes[i]; });
        each(order.size(), 1, [&](std::size_t n) { body(order[n]); });
    }

    // While it lives, the thread that made it stands in for one of the pool's, beside the caller's:
    // one of these rests, so that all together are no more than the machine has room for.
    class Beside {
      public:
        explicit Beside(ThreadPool& pool);
        ~Beside();
        Beside(const Beside&) = delete;
        Beside& operator=(const Beside&) = delete;

      private:
        ThreadPool& pool_;
    };

    // While it lives, poll() calls `poll` on the thread that made it, some twenty times a second at
    // most. One within another takes its place.
    class Polling {
      public:
        Polling(ThreadPool& pool, std::function<void()> poll);
        ~Polling();
        Polling(const Polling&) = delete;
        Polling& operator=(const Polling&) = delete;

      private:
        ThreadPool& pool_;
        std::function<void()> outer_;
        std::thread::id outer_thread_;
    };

    // For long work between runs: throws what Polling's function throws. Takes no time.
    void poll();

  private:
    // A call that shares out its chunks.
    struct Run {
        const std::function<void(std::uint64_t, std::uint64_t)>& body;
        std::uint64_t count, chunk;
        std::atomic<std::uint64_t> next{0};
        unsigned inside = 0;  // workers that take chunks; the caller waits for these alone
        std::exception_ptr
            failure{};  // of the chunk that begins at `failed`, the first that failed
        std::uint64_t failed = 0;
    };
    void work();
    void take_chunks(Run& run);
    void note_failure(Run& run, std::uint64_t first);

    std::mutex mutex_;
    std::condition_variable start_, done_;
    std::vector<Run*> runs_;  // those that may have chunks left, in the order of their calls
    std::size_t helping_ = 0, beside_ = 0;  // workers at a run; threads that stand in for others
    bool stop_ = false;
    std::vector<std::thread> workers_;
    std::function<void()> poll_;
    std::atomic<std::thread::id> polling_thread_;  // the only one that looks at poll_
    std::chrono::steady_clock::time_point polled_;
};

}  // namespace topple
