// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

// Six-direction filling (paper, 2.2.3) by walking from each voxel, on a dense grid. Of the kernels
// six_fill_sweep and six_fill_vote.
namespace topple::oracle {

// cell: 0 seen empty, 1 can be filled, 2 a surface without a vote, n + 3 the surface of primitive
// n.
struct DenseCells {
    std::array<int, 3> size{};
    std::vector<std::uint32_t> cell;
    bool inside(const std::array<int, 3>& at) const {
        for (int a = 0; a < 3; ++a) {
            if (at[a] < 0 || at[a] >= size[a]) return false;
        }
        return true;
    }
    std::size_t index(const std::array<int, 3>& at) const {
        return (static_cast<std::size_t>(at[0]) * size[1] + at[1]) * size[2] + at[2];
    }
};

struct SixHit {
    std::int32_t primitive = -1;  // -1: none
    int distance = 0;             // voxels
    bool empty = false;           // ends in space seen to be empty
};

// side: -x +x -y +y -z +z; beyond: whether what lies outside of the grid was seen to be empty.
inline SixHit walk(const DenseCells& grid, std::array<int, 3> at, int side, bool beyond = false) {
    for (int distance = 1;; ++distance) {
        at[side / 2] += side % 2 ? 1 : -1;
        if (!grid.inside(at)) return {-1, distance, beyond};
        const std::uint32_t cell = grid.cell[grid.index(at)];
        if (cell == 1) continue;
        if (cell <= 2) return {-1, distance, cell == 0};
        return {static_cast<std::int32_t>(cell) - 3, distance, false};
    }
}

// The primitive that most of the hits name, if at least `votes` do; of equals the nearest, then the
// lowest. -1 for none.
inline std::int32_t vote(const std::array<SixHit, 6>& hits, int votes) {
    std::map<std::int32_t, std::pair<int, int>> tally;  // primitive: count, nearest
    for (const SixHit& hit : hits) {
        if (hit.primitive < 0) continue;
        auto [at, fresh] = tally.try_emplace(hit.primitive, 0, hit.distance);
        ++at->second.first;
        if (hit.distance < at->second.second) at->second.second = hit.distance;
    }
    std::int32_t best = -1;
    for (const auto& [primitive, score] : tally) {
        if (score.first < votes) continue;
        if (best < 0 || score.first > tally[best].first ||
            (score.first == tally[best].first && score.second < tally[best].second)) {
            best = primitive;
        }
    }
    return best;
}

// What hides under a top: the primitive above where nothing below was seen to be empty, nor more
// than two of the four sides.
inline std::int32_t column(const std::array<SixHit, 6>& hits) {
    int open = 0;
    for (int side = 0; side < 4; ++side) open += hits[side].empty;
    return open <= 2 && !hits[4].empty ? hits[5].primitive : -1;
}

inline std::int32_t six_fill(const DenseCells& grid, const std::array<int, 3>& at, int votes,
                             bool columns = false) {
    if (grid.cell[grid.index(at)] != 1) return -1;
    std::array<SixHit, 6> hits;
    for (int side = 0; side < 6; ++side) hits[side] = walk(grid, at, side);
    const std::int32_t voted = vote(hits, votes);
    return voted < 0 && columns ? column(hits) : voted;
}

}  // namespace topple::oracle
