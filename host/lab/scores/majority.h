// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace topple::scenes {

// The label that most of `labels` have, the lowest of equals; -1 of none. Sorts them.
inline std::int32_t majority(std::vector<std::int32_t>& labels) {
    std::sort(labels.begin(), labels.end());
    std::int32_t best = -1;
    std::ptrdiff_t most = 0;
    for (auto first = labels.begin(); first != labels.end();) {
        const auto last = std::upper_bound(first, labels.end(), *first);
        if (last - first > most) {
            most = last - first;
            best = *first;
        }
        first = last;
    }
    return best;
}

}  // namespace topple::scenes
