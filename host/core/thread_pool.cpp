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
    Run own{body, count, chunk};
    {
        const std::lock_guard lock(mutex_);
        runs_.push_back(&own);
    }
    start_.notify_all();
    std::exception_ptr ended;
    try {
        take_chunks(own);
    } catch (...) {  // from the poll
        ended = std::current_exception();
        own.next.store(count, std::memory_order_relaxed);  // hands out no more
    }
    {
        std::unique_lock lock(mutex_);
        std::erase(runs_, &own);  // all is handed out: nobody comes to help any more
        done_.wait(lock, [&] { return own.inside == 0; });
    }
    if (own.failure) ended = own.failure;
    if (ended) std::rethrow_exception(ended);
}

ThreadPool::Beside::Beside(ThreadPool& pool) : pool_(pool) {
    const std::lock_guard lock(pool.mutex_);
    ++pool.beside_;
}

ThreadPool::Beside::~Beside() {
    {
        const std::lock_guard lock(pool_.mutex_);
        --pool_.beside_;
    }
    pool_.start_.notify_all();
}

void ThreadPool::poll() {
    if (std::this_thread::get_id() != polling_thread_.load(std::memory_order_relaxed)) return;
    if (!poll_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - polled_ < between_polls) return;
    polled_ = now;
    poll_();
}

ThreadPool::Polling::Polling(ThreadPool& pool, std::function<void()> poll)
    : pool_(pool),
      outer_(std::exchange(pool.poll_, std::move(poll))),
      outer_thread_(pool.polling_thread_.exchange(std::this_thread::get_id())) {
    pool.polled_ = {};
}

ThreadPool::Polling::~Polling() {
    pool_.poll_ = std::move(outer_);
    pool_.polling_thread_ = outer_thread_;
}

void ThreadPool::take_chunks(Run& run) {
    for (;;) {
        poll();
        const std::uint64_t first = run.next.fetch_add(run.chunk, std::memory_order_relaxed);
        if (first >= run.count) return;
        try {
            run.body(first, std::min(run.count, first + run.chunk));
        } catch (...) {
            note_failure(run, first);
        }
    }
}

// All chunks before this one are handed out already, and go on to their end.
void ThreadPool::note_failure(Run& run, std::uint64_t first) {
    const std::lock_guard lock(mutex_);
    if (!run.failure || first < run.failed) {
        run.failure = std::current_exception();
        run.failed = first;
    }
    run.next.store(run.count, std::memory_order_relaxed);  // hands out no more
}

void ThreadPool::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        start_.wait(lock, [&] {
            return stop_ || (!runs_.empty() && helping_ + beside_ < workers_.size());
        });
        if (stop_) return;
        Run& run = *runs_.back();
        ++run.inside;
        ++helping_;
        lock.unlock();
        take_chunks(run);
        lock.lock();
        std::erase(runs_, &run);  // all is handed out
        --helping_;
        if (--run.inside == 0) done_.notify_all();
    }
}

}  // namespace topple
