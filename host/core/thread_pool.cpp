// SPDX-License-Identifier: MIT
#include "core/thread_pool.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace topple {
namespace {

constexpr std::chrono::milliseconds between_polls{50};

}  // namespace

ThreadPool::ThreadPool(unsigned threads) {
    if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
    threads = std::min(threads, most_threads);
    workers_.reserve(threads - 1);
    try {
        while (workers_.size() + 1 < threads) workers_.emplace_back([this] { work(); });
    } catch (const std::exception&) {
        // The system has no more threads, or no memory for one: those that are there will do.
    }
}

ThreadPool::~ThreadPool() {
    {
        std::lock_guard lock(mutex_);
        stop_ = true;
    }
    start_.notify_all();
    for (auto& worker : workers_) worker.join();
}

void ThreadPool::run(std::uint64_t count, std::uint64_t chunk,
                     const std::function<void(std::uint64_t, std::uint64_t)>& body) {
    if (count == 0) return;
    chunk = std::max<std::uint64_t>(1, chunk);
    if (workers_.empty() || count <= chunk) {
        for (std::uint64_t first = 0; first < count; first += chunk) {
            poll();
            body(first, std::min(count, first + chunk));
        }
        return;
    }
    {
        std::lock_guard lock(mutex_);
        body_ = &body;
        count_ = count;
        chunk_ = chunk;
        next_.store(0, std::memory_order_relaxed);
        open_ = true;
        ++generation_;
    }
    start_.notify_all();
    std::exception_ptr ended;
    try {
        take_chunks();
    } catch (...) {  // from the poll
        ended = std::current_exception();
        next_.store(count_, std::memory_order_relaxed);  // hands out no more
    }
    {
        std::unique_lock lock(mutex_);
        open_ = false;  // all is handed out: who wakes up from now on has nothing to do
        done_.wait(lock, [this] { return inside_ == 0; });
        if (failure_) ended = std::exchange(failure_, nullptr);
    }
    if (ended) std::rethrow_exception(ended);
}

void ThreadPool::poll() {
    if (!poll_ || std::this_thread::get_id() != polling_thread_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - polled_ < between_polls) return;
    polled_ = now;
    poll_();
}

ThreadPool::Polling::Polling(ThreadPool& pool, std::function<void()> poll)
    : pool_(pool),
      outer_(std::exchange(pool.poll_, std::move(poll))),
      outer_thread_(std::exchange(pool.polling_thread_, std::this_thread::get_id())) {
    pool.polled_ = {};
}

ThreadPool::Polling::~Polling() {
    pool_.poll_ = std::move(outer_);
    pool_.polling_thread_ = outer_thread_;
}

void ThreadPool::take_chunks() {
    for (;;) {
        poll();
        const std::uint64_t first = next_.fetch_add(chunk_, std::memory_order_relaxed);
        if (first >= count_) return;
        try {
            (*body_)(first, std::min(count_, first + chunk_));
        } catch (...) {
            note_failure(first);
        }
    }
}

// All chunks before this one are handed out already, and go on to their end.
void ThreadPool::note_failure(std::uint64_t first) {
    const std::lock_guard lock(mutex_);
    if (!failure_ || first < failed_) {
        failure_ = std::current_exception();
        failed_ = first;
    }
    next_.store(count_, std::memory_order_relaxed);  // hands out no more
}

void ThreadPool::work() {
    std::uint64_t seen = 0;
    for (;;) {
        {
            std::unique_lock lock(mutex_);
            start_.wait(lock, [&] { return stop_ || generation_ != seen; });
            if (stop_) return;
            seen = generation_;
            if (!open_) continue;
            ++inside_;
        }
        take_chunks();
        std::lock_guard lock(mutex_);
        if (--inside_ == 0) done_.notify_one();
    }
}

}  // namespace topple
