// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/thread_pool.h"
#include "points/frames_cells.h"

namespace topple::geometry {

// What lies in the 27 cells around a cell, its own among them.
struct Around {
    std::uint64_t cells = 0, count = 0, weight = 0;
};

// Calls visit(i, around) for each cell, by ascending key. Each of the nine columns of three is a
// run of sorted cells whose ends only move up, and the difference of two running sums is what it
// holds.
template <class Visit>
void visit_surroundings(const CellPlaces& cells, ThreadPool& pool, const Visit& visit) {
    constexpr std::size_t chunk = std::size_t{1} << 17;
    constexpr std::uint64_t furthest = (1ull << key_shift[0]) + (1ull << key_shift[1]) + 1;
    const auto first_at = [&](std::uint64_t key) {
        return static_cast<std::size_t>(
            std::ranges::lower_bound(cells, key, {}, [](const CellSums* at) { return at->key; }) -
            cells.begin());
    };
    pool.each((cells.size() + chunk - 1) / chunk, 1, [&](std::size_t c) {
        const std::size_t first = c * chunk, last = std::min(first + chunk, cells.size());
        // What lies around these cells; behind it come more keys than a run has, above all.
        const std::size_t from = first_at(cells[first]->key - furthest),
                          n = first_at(cells[last - 1]->key + furthest + 1) - from;
        std::vector<std::uint64_t> key(n + 3, ~std::uint64_t{0}), count(n + 1), weight(n + 1);
        for (std::size_t i = 0; i < n; ++i) {
            const CellSums& at = cell_at(cells, from + i);
            key[i] = at.key;
            count[i + 1] = count[i] + at.count;
            weight[i + 1] = weight[i] + at.weight;
        }
        std::array<std::uint64_t, 9> lowest{};  // of each column, relative to the cell's key
        std::array<std::size_t, 9> lo{};
        for (std::size_t column = 0; column < 9; ++column)
            lowest[column] =
                ((column / 3) << key_shift[0]) + ((column % 3) << key_shift[1]) - furthest;
        for (std::size_t i = first - from; i < last - from; ++i) {
            Around around;
            for (std::size_t column = 0; column < 9; ++column) {
                // Mostly one or two on; which of them no branch foretells.
                const std::uint64_t low = key[i] + lowest[column];
                std::size_t at = lo[column];
                at += key[at] < low;
                at += key[at] < low;
                while (key[at] < low) ++at;
                lo[column] = at;
                const std::size_t end =
                    at + (key[at] < low + 3) + (key[at + 1] < low + 3) + (key[at + 2] < low + 3);
                around.cells += end - at;
                around.count += count[end] - count[at];
                around.weight += weight[end] - weight[at];
            }
            visit(from + i, around);
        }
    });
}

}  // namespace topple::geometry
