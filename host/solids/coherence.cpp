// SPDX-License-Identifier: MIT
#include "solids/coherence.h"

#include <algorithm>

#include "core/union_find.h"
#include "solids/boundary.h"
#include "solids/matching.h"
#include "solids/solid_places.h"

namespace topple::solids {

std::vector<bool> air_by_patches(const SolidCells& cells, std::span<const BorderVoxel> voxels,
                                 std::span<const Combination> sums) {
    std::vector<bool> air(cells.size(), false);
    each_match(
        voxels.size(), [&](std::size_t c) { return voxels[c].at; }, cells.size(),
        [&](std::size_t n) { return place_of(cells, n); },
        [&](std::size_t c, std::size_t n) {
            if (voxels[c].own && sums[c].nothing) air[n] = true;
        });
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
        out.push_back({place_of(cells, k), p, true});
        air[k] = true;
    }
    return out;
}

std::vector<bool> out_of_reach(const SolidCells& cells, std::span<const BorderVoxel> voxels,
                               std::span<const Combination> sums, const std::vector<bool>& air) {
    constexpr std::array<Place, 6> ways{
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    constexpr std::size_t axes = 3;   // of which the first ways are
    std::vector<std::size_t> beyond;  // what may hang on cells
    for (std::size_t c = 0; c < voxels.size(); ++c)
        if (!voxels[c].own && !sums[c].nothing) beyond.push_back(c);
    UnionFind pieces(beyond.size());
    for (std::size_t axis = 0; axis < axes; ++axis) {
        const auto key = [&](std::size_t n, const Place& way) {
            return BorderKey(sum_of(voxels[beyond[n]].at, way), voxels[beyond[n]].primitive);
        };
        each_match(
            beyond.size(), [&](std::size_t n) { return key(n, ways[axis]); }, beyond.size(),
            [&](std::size_t n) { return key(n, {}); },
            [&](std::size_t n, std::size_t m) { pieces.join(n, m); });
    }
    std::vector<bool> hangs(beyond.size(), false);  // by the root of its piece
    for (const Place& way : ways) {
        each_match(
            beyond.size(), [&](std::size_t n) { return sum_of(voxels[beyond[n]].at, way); },
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
