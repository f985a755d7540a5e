// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "device/native/thread_pool.h"

namespace topple::device {
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
}  // namespace topple::device
