// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <type_traits>

namespace topple {

// In rising order of what `of` says of each, and of equals the first.
template <class Of = std::identity>
void sort_unique(auto& values, const Of& of = {}) {
    if constexpr (std::is_same_v<Of, std::identity>)
        std::ranges::sort(values);
    else
        std::ranges::stable_sort(values, {}, of);
    const auto others = std::ranges::unique(values, {}, of);
    values.erase(others.begin(), others.end());
}

}  // namespace topple
