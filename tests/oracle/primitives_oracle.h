// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

// Of the data-parallel primitives: the standard library's algorithms, in 64 bits or double.
namespace topple::oracle {

using Words = std::vector<std::uint32_t>;

inline std::uint32_t low_word(std::uint64_t v) {
    return static_cast<std::uint32_t>(v & 0xffffffffu);
}

// Sums of all before an element, or up to it; of segments, where begins[i] begins one at i.
inline Words scan(const Words& values, bool inclusive, const std::vector<bool>& begins = {}) {
    Words out;
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!begins.empty() && begins[i]) sum = 0;
        out.push_back(low_word(inclusive ? sum + values[i] : sum));
        sum += values[i];
    }
    return out;
}

inline Words compact(const Words& flags, const Words& values) {
    Words out;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (flags[i]) out.push_back(values[i]);
    return out;
}

// Where the order of the elements by their keys takes each from.
inline std::vector<std::size_t> order(const std::vector<std::uint64_t>& keys) {
    std::vector<std::size_t> out(keys.size());
    std::iota(out.begin(), out.end(), std::size_t{0});
    std::stable_sort(out.begin(), out.end(),
                     [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
    return out;
}

// Whether an element begins a run of equal keys.
inline std::vector<bool> begins(const std::vector<std::uint64_t>& keys) {
    std::vector<bool> out;
    for (std::size_t i = 0; i < keys.size(); ++i) out.push_back(i == 0 || keys[i] != keys[i - 1]);
    return out;
}

inline Words segmented_sum(const std::vector<bool>& begins, const Words& values) {
    std::vector<std::uint64_t> sums;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (begins[i]) sums.push_back(0);
        sums.back() += values[i];
    }
    Words out;
    for (const std::uint64_t sum : sums) out.push_back(low_word(sum));
    return out;
}

// Sum of floats in double, and how far any order of `count` roundings to float may be from it.
inline std::pair<double, double> float_sum(const std::vector<float>& values) {
    double sum = 0, size = 0;
    for (const float v : values) {
        sum += v;
        size += std::abs(double{v});
    }
    return {sum, 1.001 * 0x1p-24 * size * static_cast<double>(values.size())};
}

// The least node of each node's component, by searches in depth.
inline Words components(std::uint32_t nodes, const Words& from, const Words& to) {
    std::vector<std::vector<std::uint32_t>> beside(nodes);
    for (std::size_t e = 0; e < from.size(); ++e) {
        if (from[e] >= nodes || to[e] >= nodes) continue;
        beside[from[e]].push_back(to[e]);
        beside[to[e]].push_back(from[e]);
    }
    Words out(nodes, ~0u);
    for (std::uint32_t node = 0; node < nodes; ++node) {
        if (out[node] != ~0u) continue;
        std::vector<std::uint32_t> open{node};
        out[node] = node;
        while (!open.empty()) {
            const std::uint32_t at = open.back();
            open.pop_back();
            for (const std::uint32_t next : beside[at]) {
                if (out[next] != ~0u) continue;
                out[next] = node;
                open.push_back(next);
            }
        }
    }
    return out;
}

// Of a sparse grid: its cells, by leaves of 8 each way, in order of both.
using Cell = std::array<std::int64_t, 3>;
struct CellsByLeaf {
    std::map<Cell, std::set<Cell>> cells_of_leaf;

    explicit CellsByLeaf(const std::vector<Cell>& cells) {
        for (const Cell& cell : cells) cells_of_leaf[leaf_of(cell)].insert(cell);
    }
    static Cell leaf_of(Cell cell) {
        for (std::int64_t& c : cell) c = c >= 0 ? c / 8 : -((7 - c) / 8);
        return cell;
    }
    std::vector<Cell> cells() const {
        std::vector<Cell> out;
        for (const auto& [leaf, cells] : cells_of_leaf)
            out.insert(out.end(), cells.begin(), cells.end());
        return out;
    }
    CellsByLeaf dilated() const {
        std::vector<Cell> out;
        for (const Cell& cell : cells()) {
            out.push_back(cell);
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (const int way : {-1, 1}) {
                    Cell beside = cell;
                    beside[axis] += way;
                    if (std::abs(beside[axis] + 0.5) < (1 << 20)) out.push_back(beside);
                }
        }
        return CellsByLeaf(out);
    }
};

}  // namespace topple::oracle
