// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace topple::graph {

// A set of integers from 0 to below its size, that is emptied at no cost.
class StampedSet {
  public:
    explicit StampedSet(std::size_t size = 0) : stamp_(size) {}
    void clear() { ++now_; }
    void clear(std::size_t size) {
        clear();
        if (stamp_.size() < size) stamp_.resize(size);
    }
    bool has(std::int32_t i) const { return stamp_[i] == now_; }
    bool add(std::int32_t i) {  // whether it is new
        return std::exchange(stamp_[i], now_) != now_;
    }

  private:
    std::vector<std::uint64_t> stamp_;
    std::uint64_t now_ = 1;
};

// Sets that are lent to any thread for a while, so that none is made anew each time. Not one for
// each thread: the system ends the process where it has no memory for those.
class ScratchSets {
  public:
    class Lent {
      public:
        explicit Lent(ScratchSets& owner) : owner_(owner) {
            const std::lock_guard lock(owner_.mutex_);
            if (owner_.idle_.empty()) {
                owner_.idle_.reserve(++owner_.made_);  // so that none is lost on its way back
                set_ = std::make_unique<StampedSet>();
            } else {
                set_ = std::move(owner_.idle_.back());
                owner_.idle_.pop_back();
            }
        }
        ~Lent() {
            const std::lock_guard lock(owner_.mutex_);
            owner_.idle_.push_back(std::move(set_));
        }
        Lent(const Lent&) = delete;
        Lent& operator=(const Lent&) = delete;
        StampedSet& operator*() const { return *set_; }

      private:
        ScratchSets& owner_;
        std::unique_ptr<StampedSet> set_;
    };

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<StampedSet>> idle_;
    std::size_t made_ = 0;
};

}  // namespace topple::graph
