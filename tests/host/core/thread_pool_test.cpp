// SPDX-License-Identifier: MIT
#include "core/thread_pool.h"

#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <new>
#include <thread>

#include "testing.h"

namespace topple {
namespace {

struct Stopped {};

TEST(Threads, share_out_every_index_once) {
    for (const unsigned threads : {1u, 3u}) {
        ThreadPool pool(threads);
        for (const std::size_t count : {0u, 1u, 7u, 8u, 1009u}) {
            std::vector<std::atomic<int>> calls(count);
            pool.each(count, 8, [&](std::size_t i) { ++calls[i]; });
            for (const auto& c : calls) EXPECT_EQ(c, 1);
        }
    }
}

// What a poll throws ends a run with no thread left at it, and leaves the pool as good as new.
TEST(Threads, a_poll_ends_a_run) {
    for (const unsigned threads : {1u, 3u}) {
        ThreadPool pool(threads);
        std::atomic<std::size_t> begun = 0, ended = 0;
        {
            const ThreadPool::Polling polling(pool, [&] {
                if (begun > 0) throw Stopped{};
            });
            constexpr std::size_t endless = std::size_t{1} << 60;
            EXPECT_THROW(pool.each(endless, 1,
                                   [&](std::size_t) {
                                       ++begun;
                                       ++ended;
                                   }),
                         Stopped);
            EXPECT_EQ(begun, ended);
        }
        std::atomic<std::size_t> count = 0;
        pool.each(1000, 1, [&](std::size_t) { ++count; });
        EXPECT_EQ(count, 1000u);
    }
}

// Of several items that fail the first one's exception arrives, with any number of threads; the
// items before it have all been done, and the pool is as good as new.
TEST(Threads, the_first_failure_reaches_the_caller) {
    for (const unsigned threads : {1u, 2u, 7u}) {
        ThreadPool pool(threads);
        for (int repeat = 0; repeat < 200; ++repeat) {
            std::vector<std::atomic<bool>> done(1000);
            try {
                pool.each(done.size(), 3, [&](std::size_t i) {
                    if (i >= 500 && i % 7 == 0) throw std::runtime_error(std::to_string(i));
                    done[i] = true;
                });
                FAIL() << "nothing was thrown";
            } catch (const std::runtime_error& error) {
                EXPECT_STREQ(error.what(), "504");
            }
            for (std::size_t i = 0; i < 504; ++i) ASSERT_TRUE(done[i]) << i;
        }
        std::atomic<std::size_t> count = 0;
        pool.each(1000, 1, [&](std::size_t) { ++count; });
        EXPECT_EQ(count, 1000u);
    }
}

TEST(Threads, memory_that_ends_on_a_worker_is_told) {
    ThreadPool pool(3);
    EXPECT_THROW(pool.each(64, 1, [](std::size_t) { throw std::bad_alloc(); }), std::bad_alloc);
}

// A process that may have no more threads gets a pool of those that it has.
TEST(Threads, a_system_without_threads_leaves_the_callers) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer takes more address space than this process may";
#endif
    const auto work = [] {
        // Root is not bound by a limit of processes: what a thread's stack takes is.
        const rlimit none{std::size_t{1} << 26, std::size_t{1} << 26};
        if (setrlimit(RLIMIT_AS, &none) != 0) std::exit(1);
        ThreadPool pool(ThreadPool::most_threads);
        std::atomic<std::size_t> count = 0;
        pool.each(1000, 1, [&](std::size_t) { ++count; });
        std::exit(count == 1000 && pool.threads() < ThreadPool::most_threads ? 0 : 1);
    };
    EXPECT_EXIT(work(), testing::ExitedWithCode(0), "");
}

// What runs in a chunk may share out its own work, and threads with nothing to do help with that.
TEST(Threads, runs_within_runs_share_the_threads) {
    for (const unsigned threads : {1u, 2u, 5u}) {
        ThreadPool pool(threads);
        for (int repeat = 0; repeat < 50; ++repeat) {
            std::vector<std::vector<std::atomic<int>>> calls(7);
            for (std::size_t n = 0; n < calls.size(); ++n)
                calls[n] = std::vector<std::atomic<int>>(100 * n);
            pool.each(calls.size(), 1, [&](std::size_t n) {
                pool.each(calls[n].size(), 3, [&](std::size_t m) { ++calls[n][m]; });
            });
            for (const auto& inner : calls)
                for (const auto& c : inner) ASSERT_EQ(c, 1);
        }
    }
}

// A chunk that waits for another one of a run within another's chunk gets a thread for it.
TEST(Threads, one_that_is_done_helps_with_what_others_share_out) {
    ThreadPool pool(2);
    std::atomic<int> at = 0;
    pool.each(2, 1, [&](std::size_t n) {
        if (n == 1) return;
        pool.each(2, 1, [&](std::size_t) {
            ++at;
            const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
            while (at < 2 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
        });
        EXPECT_EQ(at, 2);
    });
}

TEST(Threads, a_failure_within_a_run_within_a_run_reaches_the_caller) {
    ThreadPool pool(3);
    for (int repeat = 0; repeat < 50; ++repeat) {
        EXPECT_THROW(pool.each(4, 1,
                               [&](std::size_t n) {
                                   pool.each(100, 1, [&](std::size_t m) {
                                       if (n == 2 && m == 50) throw Stopped{};
                                   });
                               }),
                     Stopped);
    }
}

TEST(Threads, several_threads_may_call_at_a_time) {
    ThreadPool pool(3);
    std::vector<std::atomic<int>> calls(4);
    {
        std::vector<std::jthread> callers;
        for (auto& c : calls) {
            callers.emplace_back([&] {
                for (int repeat = 0; repeat < 100; ++repeat)
                    pool.each(50, 1, [&](std::size_t) { ++c; });
            });
        }
    }
    for (const auto& c : calls) EXPECT_EQ(c, 5000);
}

// One that stands in for a worker takes its place; afterwards there is work for that again.
TEST(Threads, one_beside_has_a_worker_rest) {
    ThreadPool pool(2);
    const auto threads_at_work = [&] {
        std::mutex mutex;
        std::set<std::thread::id> seen;
        pool.each(20, 1, [&](std::size_t) {
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
            const std::lock_guard lock(mutex);
            seen.insert(std::this_thread::get_id());
        });
        return seen.size();
    };
    {
        const ThreadPool::Beside beside(pool);
        EXPECT_EQ(threads_at_work(), 1u);
    }
    EXPECT_EQ(threads_at_work(), 2u);
}

TEST(Threads, only_the_thread_that_asked_for_it_polls) {
    ThreadPool pool(2);
    int outer = 0, inner = 0;
    const ThreadPool::Polling polling(pool, [&] { ++outer; });
    std::thread([&] { pool.poll(); }).join();
    EXPECT_EQ(outer, 0);
    {
        const ThreadPool::Polling within(pool, [&] { ++inner; });
        pool.poll();
        pool.poll();  // too soon
    }
    EXPECT_EQ(inner, 1);
    EXPECT_EQ(outer, 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    pool.poll();
    EXPECT_EQ(outer, 1);
}

}  // namespace
}  // namespace topple
