// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

// Six-direction filling (paper, 2.2.3) by walking from each voxel, on a dense grid. Of the kernels
// six_fill_sweep and six_fill_vote.
namespace topple::oracle {

// cell: 0 seen empty, 1 can be filled, 2 a surface without a vote, 3 the ground, n + 4 the surface
// of primitive n | bit by side << 16: what goes to that side meets it from where it was seen.
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

enum class End { nothing, empty, surface, ground, front, back };

struct SixHit {
    std::int32_t primitive = -1;  // -1: none
    int distance = 0;             // voxels
    End end = End::nothing;
};

// At a cell that can't be filled.
inline SixHit met(std::uint32_t cell, int side, int distance) {
    constexpr std::array<End, 4> plain{End::empty, End::nothing, End::surface, End::ground};
    if (cell < plain.size()) return {-1, distance, plain[cell]};
    return {static_cast<std::int32_t>(cell & 0xffff) - 4, distance,
            (cell >> (16 + side) & 1) != 0 ? End::front : End::back};
}

// side: -x +x -y +y -z +z; beyond: whether what lies outside of the grid was seen to be empty.
inline SixHit walk(const DenseCells& grid, std::array<int, 3> at, int side, bool beyond = false) {
    for (int distance = 1;; ++distance) {
        at[side / 2] += side % 2 ? 1 : -1;
        if (!grid.inside(at)) return {-1, distance, beyond ? End::empty : End::nothing};
        const std::uint32_t cell = grid.cell[grid.index(at)];
        if (cell != 1) return met(cell, side, distance);
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
    for (int side = 0; side < 4; ++side) open += hits[side].end == End::empty;
    return open <= 2 && hits[4].end != End::empty ? hits[5].primitive : -1;
}

// What the rays end at, as six_fill_vote numbers it.
inline std::uint32_t ends_of(const std::array<SixHit, 6>& hits) {
    std::uint32_t sides = 0;
    for (std::size_t side = 0; side < 4; ++side) sides += hits[side].end == End::back;
    const auto place = [](End end, const std::vector<End>& order) {
        return static_cast<std::uint32_t>(std::ranges::find(order, end) - order.begin());
    };
    return (place(hits[5].end, {End::back, End::front, End::empty}) * 5 + sides) * 5 +
           place(hits[4].end, {End::ground, End::back, End::front, End::empty});
}

// The nearest primitive whose back is met, of equals the lowest.
inline std::int32_t nearest_back(const std::array<SixHit, 6>& hits) {
    const SixHit* best = nullptr;
    for (const SixHit& hit : hits) {
        if (hit.end != End::back) continue;
        if (!best ||
            std::pair(hit.distance, hit.primitive) < std::pair(best->distance, best->primitive))
            best = &hit;
    }
    return best ? best->primitive : -1;
}

// What six_fill_vote tells of a voxel from where its rays end.
inline std::uint32_t told(const std::array<SixHit, 6>& hits, int votes, bool columns) {
    const std::int32_t voted = vote(hits, votes);
    const std::int32_t taken = voted < 0 && columns ? column(hits) : voted;
    const std::int32_t primitive = taken < 0 ? nearest_back(hits) : taken;
    if (primitive < 0) return 0;
    const auto count = static_cast<std::uint32_t>(
        voted < 0 ? 0 : std::ranges::count(hits, voted, &SixHit::primitive));
    return static_cast<std::uint32_t>(primitive + 1) | ends_of(hits) << 16 |
           std::uint32_t{taken >= 0} << 23 | count << 24;
}

inline std::uint32_t six_fill(const DenseCells& grid, const std::array<int, 3>& at, int votes,
                              bool columns = false) {
    if (grid.cell[grid.index(at)] != 1) return 0;
    std::array<SixHit, 6> hits;
    for (int side = 0; side < 6; ++side)
        hits[static_cast<std::size_t>(side)] = walk(grid, at, side);
    return told(hits, votes, columns);
}

}  // namespace topple::oracle
