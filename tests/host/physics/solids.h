// SPDX-License-Identifier: MIT
#pragma once

#include "core/thread_pool.h"
#include "physics/assess.h"
#include "physics/bodies.h"
#include "physics/tipping.h"
#include "standard.h"

// Analytic solids, as voxels and as exact vertex sets, for tests.
namespace topple::test {

using Inside = std::function<bool(double x, double y, double z)>;

// A label of a scene and the points that it holds.
struct Solid {
    std::int32_t label = 0;
    Inside inside;
};

// Voxels of a box of the world, [low, high] in metres, whose centres lie in one of the solids; the
// first of those takes them.
inline SolidCells voxelise(const std::vector<Solid>& solids, const Vec3& low, const Vec3& high,
                           double voxel_m) {
    SolidCells cells;
    cells.voxel_m = voxel_m;
    std::array<std::int32_t, 3> from{}, to{};
    for (std::size_t a = 0; a < 3; ++a) {
        from[a] = static_cast<std::int32_t>(std::floor(low[a] / voxel_m + 1e-6));
        to[a] = static_cast<std::int32_t>(std::ceil(high[a] / voxel_m - 1e-6));
    }
    for (std::int32_t i = from[0]; i < to[0]; ++i) {
        for (std::int32_t j = from[1]; j < to[1]; ++j) {
            for (std::int32_t k = from[2]; k < to[2]; ++k) {
                for (const Solid& solid : solids) {
                    if (!solid.inside((i + 0.5) * voxel_m, (j + 0.5) * voxel_m,
                                      (k + 0.5) * voxel_m))
                        continue;
                    cells.i.push_back(i);
                    cells.j.push_back(j);
                    cells.k.push_back(k);
                    cells.primitive.push_back(solid.label);
                    cells.basis.push_back(Basis::half_enclosed);
                    break;
                }
            }
        }
    }
    return cells;
}

inline Inside box(const Vec3& low, const Vec3& high) {
    return [=](double x, double y, double z) {
        return x > low[0] && x < high[0] && y > low[1] && y < high[1] && z > low[2] && z < high[2];
    };
}

// The convex hull of the corners of the cells in the lowest layer of label 0: what a plane below
// would touch.
inline std::vector<std::array<double, 2>> base_polygon(const SolidCells& cells) {
    const std::int32_t lowest = *std::min_element(cells.k.begin(), cells.k.end());
    std::vector<std::array<double, 2>> points;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (cells.k[n] != lowest) continue;
        for (int a = 0; a < 2; ++a) {
            for (int b = 0; b < 2; ++b) {
                points.push_back(
                    {(cells.i[n] + a) * cells.voxel_m, (cells.j[n] + b) * cells.voxel_m});
            }
        }
    }
    return physics::convex_polygon(points);
}

// A candidate of all cells of label 0 that stands on a plane.
inline physics::Candidate standing(device::Device& device, const SolidCells& cells) {
    physics::Candidate candidate;
    candidate.primitives = {0};
    const std::vector<double> density{700};
    candidate.body = physics::mass_properties(device, cells, 1, density)[0];
    candidate.support_polygon = base_polygon(cells);
    candidate.support_height_m = *std::min_element(cells.k.begin(), cells.k.end()) * cells.voxel_m;
    return candidate;
}

// Of a candidate whose parts are these, exactly, and of one whose parts are voxels.
inline physics::Stability stability(const std::vector<std::vector<Vec3>>& corners,
                                    const physics::Candidate& candidate, double resolution_m = 0) {
    return physics::assess(physics::standing_hull({corners, resolution_m}, candidate), candidate);
}
inline physics::Stability stability(const SolidCells& cells, const physics::Candidate& candidate) {
    ThreadPool one(1);
    constexpr std::size_t parts = 4;  // more than any of these solids has
    return physics::assess(
        physics::standing_hull(physics::part_hulls(cells, {}, std::vector<bool>(parts, true), one),
                               candidate),
        candidate);
}

// A regular n-gon of radius r about the z axis.
inline std::vector<std::array<double, 2>> ring(double r, unsigned n) {
    std::vector<std::array<double, 2>> points;
    for (unsigned k = 0; k < n; ++k) {
        const double angle = 2 * std::numbers::pi * k / n;
        points.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    return points;
}

// A body of given volume and centre, of density 700.
inline physics::MassProperties body(double volume_m3, const Vec3& center) {
    physics::MassProperties b;
    b.voxels = 1;
    b.volume_m3 = volume_m3;
    b.mass_kg = 700 * volume_m3;
    b.center = center;
    return b;
}

}  // namespace topple::test
