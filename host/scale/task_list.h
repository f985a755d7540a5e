// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "topple/crew.h"

namespace topple {

// A stage's tasks, for the process that hands them out. Calls may come from any thread.
class TaskList {
  public:
    void begin(std::vector<Crew::Task> tasks) {
        const std::lock_guard lock(mutex_);
        tasks_ = std::move(tasks);
        weight_.clear();
        for (const Crew::Task& task : tasks_) weight_[task.id] = task.weight;
        next_ = 0;
        finished_ = 0;
        closed_ = false;
    }
    std::optional<std::uint64_t> next(std::optional<std::uint64_t> finished) {
        const std::lock_guard lock(mutex_);
        if (finished) {
            const auto at = weight_.find(*finished);
            if (at != weight_.end()) finished_ += at->second;
        }
        if (closed_ || next_ == tasks_.size()) return std::nullopt;
        return tasks_[next_++].id;
    }
    // From here on there is none left.
    void close() {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    std::uint64_t finished() const {
        const std::lock_guard lock(mutex_);
        return finished_;
    }

  private:
    mutable std::mutex mutex_;
    std::vector<Crew::Task> tasks_;
    std::map<std::uint64_t, std::uint64_t> weight_;  // by id
    std::size_t next_ = 0;
    std::uint64_t finished_ = 0;
    bool closed_ = false;
};

}  // namespace topple
