// SPDX-License-Identifier: MIT
#include "solids/coherence.h"

#include <algorithm>

#include "core/union_find.h"
#include "solids/boundary.h"
#include "solids/matching.h"
#include "solids/place.h"

namespace topple::solids {
std::vector<bool> air_by_patches(const SolidCells& cells, std::span<const BorderVoxel> voxels,
                                 std::span<const Combination> sums) {
    std::vector<bool> air(cells.size(), false);
    std::size_t n = 0;
    for (std::size_t c = 0; c < voxels.size(); ++c) {
        if (!voxels[c].own || !sums[c].nothing) continue;
        const std::tuple at(voxels[c].i, voxels[c].j, voxels[c].k);
        while (std::tie(cells.i[n], cells.j[n], cells.k[n]) < at) ++n;
        air[n] = true;
    }
    return air;
}

std::vector<BorderVoxel> cut_off(const SolidCells& cells, std::vector<bool>& air) {
    UnionFind pieces(cells.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::vector<std::size_t> next = next_cells(cells, axis, 1);
        for (std::size_t k = 0; k < cells.size(); ++k) {
            const std::size_t m = next[k];
            if (m == no_cell || air[k] || air[m] || cells.primitive[k] != cells.primitive[m])
                continue;
            pieces.join(k, m);
        }
    }
    std::vector<bool> seen(cells.size(), false);
    std::vector<bool> any;  // by primitive: of which nothing is left that was seen stays as it is
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const std::int32_t p = cells.primitive[k];
        if (p < 0 || cells.basis[k] != Basis::surface || air[k]) continue;
        seen[pieces.root(k)] = true;
        any.resize(std::max(any.size(), static_cast<std::size_t>(p) + 1), false);
        any[p] = true;
    }
    std::vector<BorderVoxel> out;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const std::int32_t p = cells.primitive[k];
        if (p < 0 || static_cast<std::size_t>(p) >= any.size() || air[k] || seen[pieces.root(k)])
            continue;
        if (!any[p]) continue;
        out.push_back({cells.i[k], cells.j[k], cells.k[k], p, true});
        air[k] = true;
    }
    return out;
}

std::vector<bool> out_of_reach(const SolidCells& cells, std::span<const BorderVoxel> voxels,
                               std::span<const Combination> sums, const std::vector<bool>& air) {
    constexpr std::array<Place, 6> ways{
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    constexpr std::size_t axes = 3;  // of which the first ways are
    const auto place = [&](std::size_t c) { return Place{voxels[c].i, voxels[c].j, voxels[c].k}; };
    std::vector<std::size_t> beyond;  // what may hang on cells
    for (std::size_t c = 0; c < voxels.size(); ++c)
        if (!voxels[c].own && !sums[c].nothing) beyond.push_back(c);
    UnionFind pieces(beyond.size());
    for (std::size_t axis = 0; axis < axes; ++axis) {
        const auto key = [&](std::size_t n, const Place& way) {
            return std::pair(sum_of(place(beyond[n]), way), voxels[beyond[n]].primitive);
        };
        each_match(
            beyond.size(), [&](std::size_t n) { return key(n, ways[axis]); }, beyond.size(),
            [&](std::size_t n) { return key(n, {}); },
            [&](std::size_t n, std::size_t m) { pieces.join(n, m); });
    }
    std::vector<bool> hangs(beyond.size(), false);  // by the root of its piece
    for (const Place& way : ways) {
        each_match(
            beyond.size(), [&](std::size_t n) { return sum_of(place(beyond[n]), way); },
            cells.size(), [&](std::size_t n) { return place_of(cells, n); },
            [&](std::size_t n, std::size_t cell) {
                if (!air[cell] && cells.primitive[cell] == voxels[beyond[n]].primitive)
                    hangs[pieces.root(n)] = true;
            });
    }
    std::vector<bool> out(voxels.size(), false);
    for (std::size_t c = 0; c < voxels.size(); ++c) out[c] = !voxels[c].own;
    for (std::size_t n = 0; n < beyond.size(); ++n)
        if (hangs[pieces.root(n)]) out[beyond[n]] = false;
    return out;
}

}  // namespace topple::solids
