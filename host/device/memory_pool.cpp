// SPDX-License-Identifier: MIT
#include "device/memory_pool.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <utility>

namespace topple::device {
namespace {

constexpr std::size_t most_kept = 256;  // some drivers have 4096 allocations at most, for all
constexpr std::uint64_t least_capacity = 256;

}  // namespace

std::uint64_t MemoryPool::capacity_for(std::uint64_t bytes) const {
    bytes = std::max(bytes, least_capacity);
    if (bytes > most_bytes_) return bytes;  // is not kept
    const std::uint64_t step = std::bit_floor(bytes) / 4;
    return (bytes + step - 1) / step * step;
}

std::unique_ptr<Memory> MemoryPool::take(std::uint64_t capacity) {
    const auto found = of_capacity_.find(capacity);
    if (found == of_capacity_.end()) return nullptr;
    const Kept::iterator newest = found->second.back();  // the likeliest to be in a cache
    found->second.pop_back();
    if (found->second.empty()) of_capacity_.erase(found);
    std::unique_ptr<Memory> memory = std::move(*newest);
    kept_.erase(newest);
    bytes_ -= capacity;
    return memory;
}

void MemoryPool::give(std::unique_ptr<Memory> memory) {
    const std::uint64_t capacity = memory->capacity_;
    if (capacity > most_bytes_) return;
    shrink_to(most_bytes_ - capacity, most_kept - 1);
    kept_.push_back(std::move(memory));
    of_capacity_[capacity].push_back(std::prev(kept_.end()));
    bytes_ += capacity;
}

void MemoryPool::shrink_to(std::uint64_t bytes, std::size_t count) {
    while (bytes_ > bytes || kept_.size() > count) {
        const std::uint64_t capacity = kept_.front()->capacity_;
        const auto alike = of_capacity_.find(capacity);
        alike->second.pop_front();
        if (alike->second.empty()) of_capacity_.erase(alike);
        kept_.pop_front();
        bytes_ -= capacity;
    }
}

}  // namespace topple::device
