// SPDX-License-Identifier: MIT
#include "export/piece_solid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "physics/merge_close_points.h"
#include "solids/cell_shape.h"

namespace topple::exports {
namespace {

HalfSpace half_space(const SurfacePatch& patch) {
    const Vec3 g = patch.gradient(patch.origin);
    const double length = std::hypot(g[0], g[1], g[2]);
    const Vec3 n{g[0] / length, g[1] / length, g[2] / length};
    return {n, n[0] * patch.origin[0] + n[1] * patch.origin[1] + n[2] * patch.origin[2] -
                   patch.c[0] / length};
}

}  // namespace

PieceSolid PieceSolids::of(std::int32_t piece, std::span<const std::size_t> cells) {
    const double h = solids_.voxel_m(), voxel_m3 = h * h * h;
    const BoundaryCells& boundary = solids_.boundary();
    PieceSolid out;
    std::vector<Vec3> points;
    for (const std::size_t n : cells) {
        const Cell& cell = grid_[n];
        out.m3 += cell.whole() ? voxel_m3
                               : boundary.share[cell.boundary] * voxel_m3 / BoundaryCells::whole;
        if (!between_alike(n, piece)) add_corners(n, points);
    }
    constexpr double alike = 0.005;  // of a voxel
    out.hull = hull_part(physics::merge_close_points(points, alike * h));
    if (out.hull) sample(cells, out.m3, *out.hull);
    return out;
}

void PieceSolids::trim(std::span<const std::size_t> cells, ConvexPart& hull) const {
    constexpr std::size_t most_sides = 16;
    constexpr double slight_loss = 0.002;
    for (const HalfSpace& side : flat_sides(cells, most_sides)) {
        auto left = cut(hull, side);
        if (!left || left->volume_m3 == hull.volume_m3) continue;
        const auto lost = static_cast<double>(hull.solid.size() - left->solid.size());
        if (lost <= slight_loss * static_cast<double>(hull.solid.size())) hull = *std::move(left);
    }
}

std::vector<HalfSpace> PieceSolids::flat_sides(std::span<const std::size_t> cells,
                                               std::size_t most) const {
    const BoundaryCells& b = solids_.boundary();
    std::map<std::uint32_t, std::size_t> count;  // of cells, by patch
    for (const std::size_t n : cells) {
        if (grid_[n].whole()) continue;
        const std::size_t at = grid_[n].boundary;
        for (std::size_t s = 0; s < b.slots_used(at); ++s)
            if (!b.use(at, s).outside && b.patches[b.slot[s][at]].flat()) ++count[b.slot[s][at]];
    }
    // A face of the piece, and no neighbour's that it touches.
    constexpr std::size_t least_share = 50;
    std::vector<std::pair<std::size_t, std::uint32_t>> by_count;
    for (const auto& [patch, n] : count)
        if (n * least_share >= cells.size()) by_count.emplace_back(n, patch);
    std::ranges::sort(by_count, std::greater<>());
    by_count.resize(std::min(by_count.size(), most));
    std::vector<HalfSpace> out;
    for (const auto& [n, patch] : by_count) out.push_back(half_space(b.patches[patch]));
    return out;
}

// Whether a cell lies between two of its piece that are bounded as it is, so that no corner of the
// piece's hull is in it.
bool PieceSolids::between_alike(std::size_t cell, std::int32_t piece) const {
    for (std::size_t a = 0; a < 3; ++a) {
        const std::uint32_t before = grid_.beside(cell, a, false);
        const std::uint32_t after = grid_.beside(cell, a, true);
        if (grid_.is(piece, before) && grid_.is(piece, after) &&
            alike(grid_[cell], grid_[before]) && alike(grid_[cell], grid_[after]))
            return true;
    }
    return false;
}

bool PieceSolids::alike(const Cell& one, const Cell& other) const {
    if (one.whole() != other.whole()) return false;
    if (one.whole()) return true;
    const BoundaryCells& b = solids_.boundary();
    if (b.form[one.boundary] != b.form[other.boundary]) return false;
    for (std::size_t s = 0; s < b.slots_used(one.boundary); ++s) {
        if (b.slot[s][one.boundary] != b.slot[s][other.boundary] ||
            !b.patches[b.slot[s][one.boundary]].flat())
            return false;
    }
    return true;
}

// Corners of some of its cells.
void PieceSolids::sample(std::span<const std::size_t> cells, double solid_m3, ConvexPart& part) {
    constexpr std::size_t most = most_points / 8;  // corners of a voxel
    const std::size_t step = (cells.size() + most - 1) / most;
    for (std::size_t n = step / 2; n < cells.size(); n += step) add_corners(cells[n], part.solid);
    // Surfaces may leave nothing of any of these cells.
    part.solid_each_m3 = solid_m3 / std::max<double>(1, static_cast<double>(part.solid.size()));
}

void PieceSolids::add_corners(std::size_t cell, std::vector<Vec3>& out) {
    std::vector<Vec3>& corner = corner_[cell];
    if (corner.empty()) corner = corners_of(grid_[cell]);
    out.insert(out.end(), corner.begin(), corner.end());
}

std::vector<Vec3> PieceSolids::corners_of(const Cell& cell) const {
    const double h = solids_.voxel_m();
    std::vector<Vec3> out;
    if (!cell.whole()) {
        solids::add_corners(solids_.boundary(), cell.boundary, h, out);
        return out;
    }
    const auto& [i, j, k] = cell.at;
    for (const Voxel& c : Extents<std::int32_t>{cell.at, {i + 1, j + 1, k + 1}}.corners())
        out.push_back({c[0] * h, c[1] * h, c[2] * h});
    return out;
}

}  // namespace topple::exports
