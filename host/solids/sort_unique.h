// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

namespace topple::solids {

// In rising order, each once.
inline void sort_unique(auto& values) {
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace topple::solids
