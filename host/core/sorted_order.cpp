// SPDX-License-Identifier: MIT
#include "core/sorted_order.h"

#include <array>
#include <cstddef>
#include <numeric>

namespace topple {
namespace {

// sorted_order() for keys below the limit of Key.
template <class Key>
std::vector<std::uint32_t> radix_order(std::span<const std::uint64_t> keys, std::uint64_t differ) {
    struct Item {
        Key key;
        std::uint32_t index;
    };
    std::vector<Item> items(keys.size()), other(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
        items[i] = {static_cast<Key>(keys[i]), static_cast<std::uint32_t>(i)};
    constexpr unsigned bits = 11;
    for (unsigned shift = 0; shift < 8 * sizeof(Key); shift += bits) {
        constexpr std::uint64_t mask = (1u << bits) - 1;
        if ((differ >> shift & mask) == 0) continue;  // all keys agree here
        std::array<std::size_t, (1u << bits) + 1> start{};
        for (const Item& item : items) ++start[(item.key >> shift & mask) + 1];
        std::partial_sum(start.begin(), start.end(), start.begin());
        for (const Item& item : items) other[start[item.key >> shift & mask]++] = item;
        items.swap(other);
    }
    std::vector<std::uint32_t> order(keys.size());
    for (std::size_t i = 0; i < items.size(); ++i) order[i] = items[i].index;
    return order;
}

}  // namespace

std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> keys) {
    std::uint64_t any = 0, all = ~std::uint64_t{0};
    for (const std::uint64_t key : keys) {
        any |= key;
        all &= key;
    }
    return any >> 32 ? radix_order<std::uint64_t>(keys, any ^ all)
                     : radix_order<std::uint32_t>(keys, any ^ all);
}

}  // namespace topple
