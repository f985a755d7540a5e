// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
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
    bool has(std::int32_t i) const { return stamp_[static_cast<std::size_t>(i)] == now_; }
    bool add(std::int32_t i) {  // whether it is new
        return std::exchange(stamp_[static_cast<std::size_t>(i)], now_) != now_;
    }

  private:
    std::vector<std::uint64_t> stamp_;
    std::uint64_t now_ = 1;
};

}  // namespace topple::graph
