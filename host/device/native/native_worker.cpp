// SPDX-License-Identifier: MIT
#include "device/native/native_worker.h"

#include <chrono>
#include <utility>

namespace topple::device {
namespace {

constexpr std::chrono::milliseconds between_polls{50};

}  // namespace

struct NativeWorker::Job final : Running {
    Job(NativeWorker& of, std::function<void()> what) : worker(of), run(std::move(what)) {}
    bool ended() override {
        const std::lock_guard lock(worker.mutex_);
        return has_ended;
    }
    std::exception_ptr wait() override {
        std::unique_lock lock(worker.mutex_);
        while (!worker.ended_.wait_for(lock, between_polls, [&] { return has_ended; })) {
            lock.unlock();
            worker.pool_.poll();
            lock.lock();
        }
        return error;
    }

    NativeWorker& worker;
    std::function<void()> run;
    std::exception_ptr error;
    bool has_ended = false;
};

NativeWorker::~NativeWorker() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    added_.notify_one();
    thread_.join();
}

std::unique_ptr<Running> NativeWorker::add(std::function<void()> run) {
    auto job = std::make_unique<Job>(*this, std::move(run));
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back(job.get());
    }
    added_.notify_one();
    return job;
}

void NativeWorker::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        added_.wait(lock, [&] { return stop_ || !jobs_.empty(); });
        if (jobs_.empty()) return;
        Job& job = *jobs_.front();
        jobs_.pop_front();
        lock.unlock();
        std::exception_ptr error;
        try {
            job.run();
        } catch (...) {  // is thrown by who waits for it
            error = std::current_exception();
        }
        lock.lock();
        job.error = std::move(error);
        job.has_ended = true;
        ended_.notify_all();
    }
}

}  // namespace topple::device
