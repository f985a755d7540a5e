// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace topple::solids {

// Calls visit(n, m) wherever the n-th of some keys that ascend is the m-th of others that do; of
// equal ones there, the first.
template <class Key, class OtherKey, class Visit>
void each_match(std::size_t count, const Key& key, std::size_t other_count,
                const OtherKey& other_key, const Visit& visit) {
    std::size_t m = 0;
    for (std::size_t n = 0; n < count; ++n) {
        const auto wanted = key(n);
        while (m < other_count && other_key(m) < wanted) ++m;
        if (m == other_count) return;
        if (other_key(m) == wanted) visit(n, m);
    }
}

}  // namespace topple::solids
