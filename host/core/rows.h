// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace topple {

// What belongs to each of some keys, side by side in one array, in the order in which it came.
template <class T>
class Rows {
  public:
    // each(add): calls add(key, item) for all, the same ones in the same order whenever it is
    // called.
    template <class Each>
    Rows(std::size_t keys, const Each& each) : first_(keys + 1, 0) {
        each([&](std::size_t key, const T&) { ++first_[key + 1]; });
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        item_.resize(first_.back());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        each([&](std::size_t key, const T& item) { item_[next[key]++] = item; });
    }
    std::size_t size() const { return first_.size() - 1; }
    std::span<const T> operator[](std::size_t key) const {
        return std::span(item_).subspan(first_[key], first_[key + 1] - first_[key]);
    }

  private:
    std::vector<std::size_t> first_;  // of each key, and the end
    std::vector<T> item_;
};

// The places of each label below `labels`, ascending; -1 is none.
inline Rows<std::uint32_t> places_by_label(std::span<const std::int32_t> label,
                                           std::size_t labels) {
    return {labels, [&](const auto& add) {
                for (std::uint32_t n = 0; n < label.size(); ++n)
                    if (label[n] >= 0) add(static_cast<std::size_t>(label[n]), n);
            }};
}

}  // namespace topple
