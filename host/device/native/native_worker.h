// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "core/thread_pool.h"
#include "device/timeline.h"

namespace topple::device {

// A thread that runs one job after the other, while the host goes on.
class NativeWorker {
  public:
    // Throws std::system_error where the system has no more threads. pool: polled while jobs are
    // waited for.
    explicit NativeWorker(ThreadPool& pool) : pool_(pool), thread_([this] { work(); }) {}
    // All jobs must have ended.
    ~NativeWorker();
    NativeWorker(const NativeWorker&) = delete;
    NativeWorker& operator=(const NativeWorker&) = delete;

    // What is returned must outlive the job, not the worker.
    std::unique_ptr<Running> add(std::function<void()> job);

  private:
    struct Job;
    void work();

    ThreadPool& pool_;
    std::mutex mutex_;
    std::condition_variable added_, ended_;
    std::deque<Job*> jobs_;
    bool stop_ = false;
    std::thread thread_;  // last: it uses the others
};

}  // namespace topple::device
