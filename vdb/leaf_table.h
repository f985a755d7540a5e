// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/place.h"
#include "core/sort_unique.h"

namespace topple::vdb {

// The leaves that a scene can have: all of a box, and those beyond it that hold points. Leaves are
// counted in units of 8 voxels; index 0 .. size()-1 runs over the box (x, then y, then z), then
// over the others in the same order.
struct LeafTable {
    using Leaf = Place;
    Leaf low{0, 0, 0};    // of the box
    Leaf count{0, 0, 0};  // leaves per axis
    std::vector<Leaf> beyond;

    std::uint64_t box_size() const {
        return static_cast<std::uint64_t>(count[0]) * static_cast<std::uint64_t>(count[1]) *
               static_cast<std::uint64_t>(count[2]);
    }
    std::uint64_t size() const { return box_size() + beyond.size(); }

    bool in_box(const Leaf& leaf) const {
        for (int a = 0; a < 3; ++a) {
            if (leaf[a] < low[a] || leaf[a] - low[a] >= count[a]) return false;
        }
        return true;
    }
    Leaf leaf_at(std::uint64_t index) const {
        if (index >= box_size()) return beyond[index - box_size()];
        const auto z = static_cast<std::int32_t>(index % count[2]);
        const auto y = static_cast<std::int32_t>(index / count[2] % count[1]);
        const auto x = static_cast<std::int32_t>(index / count[2] / count[1]);
        return {low[0] + x, low[1] + y, low[2] + z};
    }
    // -1 where the table has no such leaf.
    std::int64_t index_of(const Leaf& leaf) const {
        if (in_box(leaf)) {
            return (static_cast<std::int64_t>(leaf[0] - low[0]) * count[1] + (leaf[1] - low[1])) *
                       count[2] +
                   (leaf[2] - low[2]);
        }
        const auto at = std::lower_bound(beyond.begin(), beyond.end(), leaf);
        if (at == beyond.end() || *at != leaf) return -1;
        return static_cast<std::int64_t>(box_size()) + (at - beyond.begin());
    }
    // Takes in those of so many leaves that lie beyond the box.
    template <class LeafAt>
    void take_in(std::size_t leaves, const LeafAt& leaf_at) {
        for (std::size_t n = 0; n < leaves; ++n)
            if (const Leaf leaf = leaf_at(n); !in_box(leaf)) beyond.push_back(leaf);
        sort_unique(beyond);
    }
    // Voxel that the kernels' float coordinates are relative to: they stay small, hence exact.
    Leaf reference() const { return {low[0] * 8, low[1] * 8, low[2] * 8}; }
};

}  // namespace topple::vdb
