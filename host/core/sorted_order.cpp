// SPDX-License-Identifier: MIT
#include "core/sorted_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace topple {
namespace {

// So many keys to a part, which one thread counts and moves: then a digit's counts are few beside
// them.
constexpr std::size_t part_keys = std::size_t{1} << 16;
constexpr unsigned digit_bits = 11;
constexpr std::size_t digits = std::size_t{1} << digit_bits;

// sorted_order() for keys below the limit of Key.
template <class Key>
std::vector<std::uint32_t> radix_order(std::span<const std::uint64_t> keys, std::uint64_t differ,
                                       ThreadPool& threads) {
    struct Item {
        Key key;
        std::uint32_t index;
    };
    std::vector<Item> items(keys.size()), other(keys.size());
    const std::size_t parts = (keys.size() + part_keys - 1) / part_keys;
    const auto each_of = [&](std::size_t part, const auto& use) {
        for (std::size_t i = part * part_keys; i < std::min((part + 1) * part_keys, keys.size());
             ++i)
            use(i);
    };
    threads.each(parts, 1, [&](std::size_t part) {
        each_of(part, [&](std::size_t i) {
            items[i] = {static_cast<Key>(keys[i]), static_cast<std::uint32_t>(i)};
        });
    });
    std::vector<std::array<std::uint32_t, digits>> start(parts);
    for (unsigned shift = 0; shift < 8 * sizeof(Key); shift += digit_bits) {
        const auto digit = [&](std::uint64_t key) { return key >> shift & (digits - 1); };
        if (digit(differ) == 0) continue;  // all keys agree here
        threads.each(parts, 1, [&](std::size_t part) {
            start[part].fill(0);
            each_of(part, [&](std::size_t i) { ++start[part][digit(items[i].key)]; });
        });
        std::uint32_t before = 0;
        for (std::size_t d = 0; d < digits; ++d)
            for (auto& of_part : start) before += std::exchange(of_part[d], before);
        threads.each(parts, 1, [&](std::size_t part) {
            each_of(part,
                    [&](std::size_t i) { other[start[part][digit(items[i].key)]++] = items[i]; });
        });
        items.swap(other);
    }
    std::vector<std::uint32_t> order(keys.size());
    threads.each(parts, 1, [&](std::size_t part) {
        each_of(part, [&](std::size_t i) { order[i] = items[i].index; });
    });
    return order;
}

}  // namespace

std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> keys, ThreadPool& threads) {
    std::uint64_t any = 0, all = ~std::uint64_t{0};
    for (const std::uint64_t key : keys) {
        any |= key;
        all &= key;
    }
    return any >> 32 ? radix_order<std::uint64_t>(keys, any ^ all, threads)
                     : radix_order<std::uint32_t>(keys, any ^ all, threads);
}

std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> keys) {
    ThreadPool alone(1);
    return sorted_order(keys, alone);
}

}  // namespace topple
