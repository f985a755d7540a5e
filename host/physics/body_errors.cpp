// SPDX-License-Identifier: MIT
#include "physics/body_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "solids/boundary.h"
#include "solids/cell_shape.h"
#include "solids/solid_places.h"

namespace topple::physics {
namespace {

// What a side of a solid of thickness t is off, in h^2 / t: of two voxels h or less, little of its
// surface is seen by itself. Found from things of known measures (docs/evaluation.md).
constexpr double thin_error = 0.06;

// A sum of pieces of surface, or of volume.
struct Pieces {
    double size = 0;
    Vec3 moment{};
    void add(double more, const Vec3& at) {
        size += more;
        for (std::size_t a = 0; a < 3; ++a) moment[a] += more * at[a];
    }
    Vec3 center() const {
        Vec3 out = moment;
        for (double& v : out) v /= size;
        return out;
    }
};

// Part of a primitive's surface, with the primitive that it borders on there or -1.
struct Side {
    std::int32_t primitive, from;
    Pieces pieces;
    double off_m;  // by how it was seen
};

Vec3 middle(std::int32_t i, std::int32_t j, std::int32_t k, double h) {
    return {(i + 0.5) * h, (j + 0.5) * h, (k + 0.5) * h};
}

// A plane crosses (|nx| + |ny| + |nz|) voxels for each square of a voxel's side.
double area_within(const Vec3& gradient, double h) {
    const double length = std::hypot(gradient[0], gradient[1], gradient[2]);
    return h * h * length / (std::abs(gradient[0]) + std::abs(gradient[1]) + std::abs(gradient[2]));
}

// Of the six directions along axes, the one that a gradient is nearest to.
int facing(const Vec3& gradient) {
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a)
        if (std::abs(gradient[a]) > std::abs(gradient[axis])) axis = a;
    return 2 * static_cast<int>(axis) + (gradient[axis] > 0);
}

// What a curved patch is off on one side is not what it is on another.
void add_patches(const BoundaryCells& b, double h, std::vector<Side>& out) {
    std::map<std::tuple<std::int32_t, std::uint32_t, int>, Pieces> pieces;  // primitive, patch, way
    for (std::size_t n = 0; n < b.size(); ++n) {
        const Vec3 at = middle(b.i[n], b.j[n], b.k[n], h);
        std::array<std::uint32_t, BoundaryCells::slots> through{};
        std::size_t count = 0;
        for (std::size_t s = 0; s < b.slots_used(n); ++s) {
            const SurfacePatch& patch = b.patches[b.slot[s][n]];
            const double d = patch.distance(at), half = solids::reach_of(patch.gradient(at), h);
            // Of two voxels that a patch lies between, it passes one.
            if (d > -half && d <= half) through[count++] = b.slot[s][n];
        }
        for (std::size_t s = 0; s < count; ++s) {
            const Vec3 gradient = b.patches[through[s]].gradient(at);
            pieces[{b.primitive[n], through[s], facing(gradient)}].add(
                area_within(gradient, h) / static_cast<double>(count), at);
        }
    }
    for (const auto& [key, sum] : pieces) {
        const auto& [primitive, seen, way] = key;
        const SurfacePatch& patch = b.patches[seen];
        const std::int32_t from = patch.primitive == primitive ? -1 : patch.primitive;
        out.push_back({primitive, from, sum, patch.offset_m});
    }
}

// Sides of cells that no patch bounds and that are the border of their primitive.
void add_unseen_sides(const SolidCells& cells, const std::vector<bool>& bounded,
                      std::vector<Side>& out) {
    const double h = cells.voxel_m;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::vector<std::size_t> next = solids::next_cells(cells, axis, 1);
        std::vector<std::size_t> previous(cells.size(), solids::no_cell);
        for (std::size_t n = 0; n < next.size(); ++n)
            if (next[n] != solids::no_cell) previous[next[n]] = n;
        for (const int way : {-1, 1}) {
            std::map<std::pair<std::int32_t, std::int32_t>, Pieces> pieces;  // primitive, other
            for (std::size_t n = 0; n < cells.size(); ++n) {
                const std::int32_t p = cells.primitive[n];
                const std::size_t m = way < 0 ? previous[n] : next[n];
                const std::int32_t other = m == solids::no_cell ? -1 : cells.primitive[m];
                if (p < 0 || bounded[n] || other == p || (m != solids::no_cell && bounded[m]))
                    continue;
                Vec3 at = middle(cells.i[n], cells.j[n], cells.k[n], h);
                at[axis] += 0.5 * way * h;
                pieces[{p, other}].add(h * h, at);
            }
            for (const auto& [key, sum] : pieces)
                out.push_back({key.first, key.second, sum, solids::voxel_error * h});
        }
    }
}

// shares: of each cell, the part that is its primitive's.
void add_guesses(const SolidCells& cells, std::span<const double> shares,
                 std::vector<VolumeError>& out) {
    std::map<std::pair<std::int32_t, Basis>, Pieces> pieces;
    const double cube = cells.voxel_m * cells.voxel_m * cells.voxel_m;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (cells.primitive[n] < 0 || cells.basis[n] < Basis::half_enclosed || !(shares[n] > 0))
            continue;
        pieces[{cells.primitive[n], cells.basis[n]}].add(
            shares[n] * cube, middle(cells.i[n], cells.j[n], cells.k[n], cells.voxel_m));
    }
    for (const auto& [key, sum] : pieces)
        out.push_back(
            {key.first, -1, (1 - probability_solid(key.second)) * sum.size, sum.center()});
}

// The thickness of each primitive that has sides: what a board of its volume and surface has.
std::map<std::int32_t, double> thicknesses(const SolidCells& cells, std::span<const double> shares,
                                           std::span<const Side> sides) {
    std::map<std::int32_t, double> area, out;
    for (const Side& side : sides) area[side.primitive] += side.pieces.size;
    const double cube = cells.voxel_m * cells.voxel_m * cells.voxel_m;
    for (std::size_t n = 0; n < cells.size(); ++n)
        if (area.contains(cells.primitive[n])) out[cells.primitive[n]] += shares[n] * cube;
    for (auto& [primitive, thickness] : out) thickness *= 2 / area[primitive];
    return out;
}

}  // namespace

std::vector<VolumeError> volume_errors(const SolidCells& cells, const BoundaryCells& boundary) {
    std::vector<bool> bounded(cells.size(), false);
    std::vector<double> shares(cells.size(), 1.0);
    solids::each_bounded_cell(cells, boundary, [&](std::size_t b, std::size_t n) {
        bounded[n] = true;
        if (cells.primitive[n] == boundary.primitive[b])
            shares[n] = static_cast<double>(boundary.share[b]) / BoundaryCells::whole;
    });
    std::vector<Side> sides;
    add_patches(boundary, cells.voxel_m, sides);
    add_unseen_sides(cells, bounded, sides);
    const std::map<std::int32_t, double> thickness = thicknesses(cells, shares, sides);
    std::vector<VolumeError> out;
    for (const Side& side : sides) {
        const auto found = thickness.find(side.primitive);
        const double h = cells.voxel_m;
        // Of less than a quarter of a voxel nothing is known that would be more than its surface's.
        const double t = std::max(found == thickness.end() ? 0 : found->second, 0.25 * h);
        const double off = std::hypot(side.off_m, thin_error * h * h / t);
        out.push_back({side.primitive, side.from, off * side.pieces.size, side.pieces.center()});
    }
    add_guesses(cells, shares, out);
    std::ranges::stable_sort(out, {}, &VolumeError::primitive);
    return out;
}

BodyError body_error(const MassProperties& body, std::span<const std::int32_t> primitives,
                     std::span<const VolumeError> errors, std::span<const double> densities) {
    BodyError out;
    if (!(body.mass_kg > 0)) return out;
    double mass = 0;
    Vec3 moment{};
    for (const std::int32_t p : primitives) {
        auto e = std::ranges::lower_bound(errors, p, {}, &VolumeError::primitive);
        for (; e != errors.end() && e->primitive == p; ++e) {
            if (e->from >= 0 && std::ranges::binary_search(primitives, e->from)) continue;
            const double more = e->volume_m3 * densities[p];
            mass += more * more;
            for (std::size_t a = 0; a < 3; ++a) {
                const double turn = more * (e->center[a] - body.center[a]);
                moment[a] += turn * turn;
            }
        }
    }
    out.mass_kg = std::sqrt(mass);
    for (std::size_t a = 0; a < 3; ++a) out.center_m[a] = std::sqrt(moment[a]) / body.mass_kg;
    return out;
}

}  // namespace topple::physics
