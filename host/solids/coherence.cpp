// SPDX-License-Identifier: MIT
#include "solids/coherence.h"

#include <algorithm>

#include "core/union_find.h"
#include "solids/boundary.h"

namespace topple::solids {
namespace {

using Place = std::array<std::int32_t, 3>;

Place sum_of(const Place& a, const Place& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

}  // namespace

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
        any[static_cast<std::size_t>(p)] = true;
    }
    std::vector<BorderVoxel> out;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const std::int32_t p = cells.primitive[k];
        if (p < 0 || static_cast<std::size_t>(p) >= any.size() || air[k] || seen[pieces.root(k)])
            continue;
        if (!any[static_cast<std::size_t>(p)]) continue;
        out.push_back({cells.i[k], cells.j[k], cells.k[k], p, true});
        air[k] = true;
    }
    return out;
}

std::vector<bool> out_of_reach(const SolidCells& cells, std::span<const BorderVoxel> voxels,
                               std::span<const Combination> sums, const std::vector<bool>& air) {
    constexpr std::array<Place, 6> ways{
        {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
    const auto place = [&](std::size_t c) { return Place{voxels[c].i, voxels[c].j, voxels[c].k}; };
    std::vector<bool> out(voxels.size(), false);
    std::vector<std::size_t> open;
    for (std::size_t c = 0; c < voxels.size(); ++c) out[c] = !voxels[c].own;
    for (const Place& way : ways) {
        std::size_t n = 0;
        for (std::size_t c = 0; c < voxels.size(); ++c) {
            if (voxels[c].own || sums[c].nothing || !out[c]) continue;
            const Place at = sum_of(place(c), way);
            while (n < cells.size() && Place{cells.i[n], cells.j[n], cells.k[n]} < at) ++n;
            if (n == cells.size()) break;
            if (Place{cells.i[n], cells.j[n], cells.k[n]} != at || air[n] ||
                cells.primitive[n] != voxels[c].primitive)
                continue;
            out[c] = false;
            open.push_back(c);
        }
    }
    for (std::size_t at = 0; at < open.size(); ++at) {
        for (const Place& way : ways) {
            const Place p = sum_of(place(open[at]), way);
            const CellKey key{p[0], p[1], p[2], voxels[open[at]].primitive};
            const auto beside = std::ranges::lower_bound(voxels, key, {}, &BorderVoxel::key);
            if (beside == voxels.end() || beside->key() != key) continue;
            const auto c = static_cast<std::size_t>(beside - voxels.begin());
            if (!out[c] || sums[c].nothing) continue;
            out[c] = false;
            open.push_back(c);
        }
    }
    return out;
}

}  // namespace topple::solids
