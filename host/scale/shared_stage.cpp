// SPDX-License-Identifier: MIT
#include "scale/shared_stage.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "core/thread_pool.h"
#include "scale/task_list.h"

namespace topple {
namespace {

class LoneCrew final : public Crew {
  public:
    void begin(const std::string&, std::vector<Task> tasks) override {
        tasks_.begin(std::move(tasks));
    }
    std::uint64_t finished() const override { return tasks_.finished(); }
    std::optional<std::string> wait() override { return std::nullopt; }
    std::optional<std::uint64_t> next(std::optional<std::uint64_t> finished) override {
        return tasks_.next(finished);
    }
    void end(std::exception_ptr failed, const std::function<void()>&) override {
        if (failed) std::rethrow_exception(failed);
    }

  private:
    TaskList tasks_;
};

}  // namespace

std::unique_ptr<Crew> lone_crew() {
    return std::make_unique<LoneCrew>();
}

void large_first(std::vector<Crew::Task>& tasks) {
    std::ranges::stable_sort(tasks, std::ranges::greater{}, &Crew::Task::weight);
}

void work_off(Crew& crew, device::Device& device, unsigned lanes,
              const std::function<void(std::uint64_t)>& work, const std::function<void()>& tell) {
    std::mutex mutex;
    std::exception_ptr failed;
    std::atomic<bool> stop{false};
    const auto lane = [&](std::size_t) {
        try {
            std::optional<std::uint64_t> task;
            while (!stop && (task = crew.next(task))) {
                work(*task);
                const std::lock_guard lock(mutex);
                tell();
            }
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!failed) failed = std::current_exception();
            stop = true;
        }
    };
    try {
        device.threads().each(lanes, 1, lane);
    } catch (...) {  // cancelled between two lanes
        if (!failed) failed = std::current_exception();
    }
    crew.end(failed, tell);
}

}  // namespace topple
