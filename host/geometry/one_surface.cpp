// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/algebraic_model.h"
#include "geometry/face_limits.h"
#include "geometry/merge.h"
#include "geometry/split.h"

// Whether what several regions or surfels show is one surface.
namespace topple::geometry {
namespace {

// Pieces of a level plane that bounds the scene (a floor, or a table among things) are one where at
// most this share of the surfels around them lies below it, strays, and each holds at least this
// share of all surfels. Set by hand.
constexpr double most_behind_share = 0.01, least_level_share = 0.002;

}  // namespace

// Surfels are sorted by cell.
std::int64_t surfel_at(const Surfels& s, const Eigen::Vector3d& p) {
    const auto cell = [&](double v) { return static_cast<std::int32_t>(std::floor(v / s.cell_m)); };
    const std::tuple<std::int32_t, std::int32_t, std::int32_t> wanted{cell(p.x()), cell(p.y()),
                                                                      cell(p.z())};
    std::size_t low = 0, high = s.size();
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (std::tie(s.cx[middle], s.cy[middle], s.cz[middle]) < wanted)
            low = middle + 1;
        else
            high = middle;
    }
    if (low == s.size() || std::tie(s.cx[low], s.cy[low], s.cz[low]) != wanted) return -1;
    return static_cast<std::int64_t>(low);
}

bool coplanar(const Regions& regions, const std::vector<RegionSamples>& samples, std::size_t a,
              std::size_t b, double slack_m) {
    if (regions.regions[a].model.degree != 1 || regions.regions[b].model.degree != 1) return false;
    if (samples[a].points.empty() || samples[b].points.empty()) return false;
    if (samples[a].normals.front().dot(samples[b].normals.front()) < parallel_cos) return false;
    const auto off = [&](std::size_t points, std::size_t plane) {
        double sum = 0;
        for (const auto& p : samples[points].points)
            sum += std::abs(distance(regions.regions[plane].model, p));
        return sum / static_cast<double>(samples[points].points.size());
    };
    const double bound = std::max(samples[a].tolerance_m, samples[b].tolerance_m) + slack_m;
    return std::min(off(a, b), off(b, a)) <= bound;
}

bool ledge_between(const PrimitiveSet& primitives, std::size_t i, std::size_t j) {
    const std::int32_t a = primitives.faces.label[i], b = primitives.faces.label[j];
    return a >= 0 && b >= 0 && on_two_sides(primitives.ledges[a], primitives.ledges[b]);
}

bool in_one_surface(const Surfels& surfels, const PrimitiveSet& primitives, std::size_t i,
                    std::size_t j) {
    const Regions& regions = primitives.faces;
    const std::int32_t a = regions.label[i], b = regions.label[j];
    if (a < 0 || b < 0) return false;
    const Region &ra = regions.regions[a], &rb = regions.regions[b];
    if (a == b) return true;
    if (ledge_between(primitives, i, j)) return false;
    const Eigen::Vector3d p = position(surfels, i), q = position(surfels, j);
    if (gradient(ra.model, p).normalized().dot(gradient(rb.model, q).normalized()) < parallel_cos)
        return false;
    const double bound = own_surface_m(std::max(ra.residual_m, rb.residual_m), surfels.cell_m);
    return std::abs(distance(ra.model, q)) <= bound && std::abs(distance(rb.model, p)) <= bound;
}

std::vector<std::pair<std::int32_t, std::int32_t>> find_level_pieces(
    const Surfels& surfels, const Vec3& up, const Regions& regions,
    const std::vector<RegionSamples>& samples) {
    const Eigen::Vector3d upwards(up[0], up[1], up[2]);
    std::vector<std::size_t> large;
    for (std::size_t k = 0; k < regions.regions.size(); ++k)
        if (regions.regions[k].model.degree == 1 && !samples[k].normals.empty() &&
            samples[k].normals.front().dot(upwards) > parallel_cos &&
            static_cast<double>(regions.regions[k].surfels) >=
                least_level_share * static_cast<double>(surfels.size()))
            large.push_back(k);
    const std::size_t step = surfels.size() / 20000 + 1;

    // Whether nothing is behind the plane of `k` within the box around both regions.
    const auto bounds_scene = [&](std::size_t k, std::size_t other, double tolerance) {
        const AlgebraicModel& plane = regions.regions[k].model;
        const Eigen::Vector3d n = samples[k].normals.front();
        const Eigen::Vector3d u = n.unitOrthogonal(), v = n.cross(u);
        Eigen::Array2d low(1e30, 1e30), high(-1e30, -1e30);
        for (const std::size_t r : {k, other})
            for (const auto& p : samples[r].points) {
                const Eigen::Array2d q(u.dot(p), v.dot(p));
                low = low.min(q);
                high = high.max(q);
            }
        std::uint64_t behind = 0, all = 0;
        for (std::size_t i = 0; i < surfels.size(); i += step) {
            const Eigen::Vector3d p(surfels.x[i], surfels.y[i], surfels.z[i]);
            const Eigen::Array2d q(u.dot(p), v.dot(p));
            if ((q < low).any() || (q > high).any()) continue;
            ++all;
            behind += distance(plane, p) < -tolerance;
        }
        return static_cast<double>(behind) <= most_behind_share * static_cast<double>(all);
    };

    std::vector<std::pair<std::int32_t, std::int32_t>> pieces;
    for (std::size_t x = 0; x < large.size(); ++x)
        for (std::size_t y = x + 1; y < large.size(); ++y) {
            if (!coplanar(regions, samples, large[x], large[y], surfels.cell_m)) continue;
            const double tolerance =
                std::max(samples[large[x]].tolerance_m, samples[large[y]].tolerance_m);
            const std::size_t larger =
                regions.regions[large[x]].surfels >= regions.regions[large[y]].surfels ? large[x]
                                                                                       : large[y];
            const std::size_t smaller = larger == large[x] ? large[y] : large[x];
            if (bounds_scene(larger, smaller, tolerance + 2 * surfels.cell_m))
                pieces.emplace_back(static_cast<std::int32_t>(large[x]),
                                    static_cast<std::int32_t>(large[y]));
        }
    return pieces;
}

}  // namespace topple::geometry
