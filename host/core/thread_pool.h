// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace topple {

// A fixed set of threads that share out ranges of an index space. The caller's thread works too.
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
    void work();
    void take_chunks();
    void note_failure(std::uint64_t first);

    std::mutex mutex_;
    std::condition_variable start_, done_;
    std::uint64_t generation_ = 0;
    bool open_ = false;    // whether there may be chunks left
    unsigned inside_ = 0;  // workers that take chunks; the caller waits for these alone
    bool stop_ = false;
    const std::function<void(std::uint64_t, std::uint64_t)>* body_ = nullptr;
    std::uint64_t count_ = 0, chunk_ = 1;
    std::atomic<std::uint64_t> next_{0};
    std::exception_ptr failure_;  // of the chunk that begins at failed_, the first that failed
    std::uint64_t failed_ = 0;
    std::vector<std::thread> workers_;
    std::function<void()> poll_;
    std::thread::id polling_thread_;
    std::chrono::steady_clock::time_point polled_;
};

}  // namespace topple
