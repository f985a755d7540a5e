// SPDX-License-Identifier: MIT
#include "geometry/shell_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/ranked.h"

namespace topple::geometry {
namespace {

using Eigen::Vector3d;

constexpr std::array<std::string_view, 49> names{"edge",
                                                 "log_area",
                                                 "area_share",
                                                 "area_of_largest",
                                                 "thickness",
                                                 "width",
                                                 "length",
                                                 "thickness_over_edge",
                                                 "up_share",
                                                 "down_share",
                                                 "side_share",
                                                 "normal_length",
                                                 "face_z",
                                                 "face_aligned",
                                                 "low_above_floor",
                                                 "high_above_floor",
                                                 "below_top",
                                                 "height",
                                                 "height_share",
                                                 "level_length",
                                                 "length_share",
                                                 "filled",
                                                 "behind_share",
                                                 "before_share",
                                                 "behind_near_share",
                                                 "depth_behind",
                                                 "depth_before",
                                                 "rim_distance",
                                                 "center_rim",
                                                 "back_met_30",
                                                 "back_met_100",
                                                 "back_met_400",
                                                 "front_met_30",
                                                 "front_met_100",
                                                 "front_met_400",
                                                 "down_met_20",
                                                 "down_met_60",
                                                 "down_met_300",
                                                 "up_met_20",
                                                 "up_met_100",
                                                 "up_met_400",
                                                 "level_below",
                                                 "level_above",
                                                 "scene_height",
                                                 "scene_length",
                                                 "scene_width",
                                                 "scene_area",
                                                 "upright_share",
                                                 "tallest_upright"};

// Rays from a primitive that say what is around it.
constexpr std::size_t most_rays = 120;

struct Scene {
    const PrimitiveShapes& shapes;
    double largest_m2 = 0, upright_m2 = 0, tallest_upright_m = 0;
    explicit Scene(const PrimitiveShapes& all) : shapes(all) {
        for (const PrimitiveShape& p : all.of) {
            largest_m2 = std::max(largest_m2, p.area_m2);
            if (p.side_share < 0.7 || p.normal.norm() < 0.8) continue;
            upright_m2 += p.area_m2;
            if (p.area_m2 > 0.5)
                tallest_upright_m = std::max(tallest_upright_m, p.high[2] - p.low[2]);
        }
    }
    Vector3d size() const { return (shapes.high - shapes.low).cwiseMax(1e-3); }
};

// Shares of the samples that see something within some distances along a direction.
template <std::size_t N>
std::array<float, N> met(const SurfaceSamples& s, const PrimitiveShape& p, const SightLines& lines,
                         const Vector3d& direction, const std::array<double, N>& within_m) {
    std::array<float, N> out{};
    const double start = 1.5 * lines.cell_m();
    const std::size_t step = std::max<std::size_t>(1, p.samples() / most_rays);
    std::size_t rays = 0;
    for (std::size_t n = p.first; n < p.last; n += step, ++rays) {
        const double t = lines.met_m({s.x[n], s.y[n], s.z[n]}, direction, start, within_m.back());
        for (std::size_t k = 0; k < N; ++k) out[k] += t <= within_m[k];
    }
    for (float& share : out) share /= static_cast<float>(std::max<std::size_t>(1, rays));
    return out;
}

// How the scene lies about the plane of a face: the shares of all samples behind it and before it,
// the share close behind it, and how far it goes on at either side. some: of the samples.
std::array<double, 5> sides(std::span<const Vector3d> some, double spacing_m,
                            const PrimitiveShape& p, const Vector3d& face) {
    const double slack = std::max(0.06, 1.5 * spacing_m);
    std::vector<double> distance;
    distance.reserve(some.size());
    for (const Vector3d& at : some) distance.push_back((at - p.center).dot(face));
    double behind = 0, before = 0, near = 0;
    for (const double d : distance) {
        behind += d < -slack;
        before += d > slack;
        near += d < -slack && d > -0.5;
    }
    const double count = static_cast<double>(std::max<std::size_t>(1, distance.size()));
    return {behind / count, before / count, near / count, -quantile(distance, 0.005),
            quantile(distance, 0.995)};
}

// Area of what looks up below it, or down above it, as a share of all that does.
std::array<double, 2> levels(const PrimitiveShapes& shapes, const PrimitiveShape& p) {
    double below = 0, above = 0, up = 1e-6, down = 1e-6;
    for (const PrimitiveShape& other : shapes.of) {
        const double up_m2 = other.up_share * other.area_m2,
                     down_m2 = other.down_share * other.area_m2;
        up += up_m2;
        down += down_m2;
        if (other.center[2] < p.center[2] - 0.05) below += up_m2;
        if (other.center[2] > p.center[2] + 0.05) above += down_m2;
    }
    return {below / up, above / down};
}

}  // namespace

std::span<const std::string_view> shell_feature_names() {
    return names;
}

std::vector<float> shell_features(const SurfaceSamples& s, const PrimitiveShapes& shapes,
                                  const SightLines& lines, ThreadPool& threads) {
    const Scene scene(shapes);
    const Vector3d size = scene.size();
    std::vector<Vector3d> some;
    const std::size_t step = std::max<std::size_t>(1, s.size() / 4000);
    for (std::size_t n = 0; n < s.size(); n += step) some.emplace_back(s.x[n], s.y[n], s.z[n]);
    std::vector<float> rows(shapes.of.size() * names.size());
    threads.each(shapes.of.size(), 4, [&](std::size_t number) {
        const PrimitiveShape& p = shapes.of[number];
        const Vector3d face = p.face();
        // What stands upright is asked what is behind it at its own height.
        const bool upright = std::abs(face[2]) < 0.5;
        Vector3d out = upright ? Vector3d(face[0], face[1], 0).normalized()
                               : Vector3d(0, 0, face[2] > 0 ? 1 : -1);
        const Vector3d extent = p.high - p.low;
        const Vector3d along = upright ? Vector3d(-out[1], out[0], 0) : Vector3d(1, 0, 0);
        double low = INFINITY, high = -INFINITY;
        for (std::size_t n = p.first; n < p.last; ++n) {
            const double t = along[0] * s.x[n] + along[1] * s.y[n];
            low = std::min(low, t);
            high = std::max(high, t);
        }
        const double length = p.samples() ? high - low : 0;
        const double scene_length = std::abs(along[0]) * size[0] + std::abs(along[1]) * size[1];
        const double rectangle = upright ? (length + s.spacing_m) * (extent[2] + s.spacing_m)
                                         : (extent[0] + s.spacing_m) * (extent[1] + s.spacing_m);
        const auto [behind, before, near, depth_behind, depth_before] =
            sides(some, s.spacing_m, p, face);
        const auto back = met<3>(s, p, lines, -out, {0.3, 1, 4});
        const auto front = met<3>(s, p, lines, out, {0.3, 1, 4});
        const auto down = met<3>(s, p, lines, {0, 0, -1}, {0.25, 0.6, 3});
        const auto up = met<3>(s, p, lines, {0, 0, 1}, {0.25, 1, 4});
        const auto [level_below, level_above] = levels(shapes, p);
        // How far its nearest and its middle are from the sides of the scene's bounds.
        double rim = INFINITY, center_rim = INFINITY;
        for (Eigen::Index a = 0; a < 2; ++a) {
            rim = std::min({rim, p.low[a] - shapes.low[a], shapes.high[a] - p.high[a]});
            center_rim =
                std::min({center_rim, p.center[a] - shapes.low[a], shapes.high[a] - p.center[a]});
        }
        const std::array<double, names.size()> row{s.spacing_m,
                                                   std::log(p.area_m2 + 1e-4),
                                                   p.area_m2 / shapes.area_m2,
                                                   p.area_m2 / scene.largest_m2,
                                                   p.spread[0],
                                                   p.spread[1],
                                                   p.spread[2],
                                                   p.spread[0] / s.spacing_m,
                                                   p.up_share,
                                                   p.down_share,
                                                   p.side_share,
                                                   p.normal.norm(),
                                                   face[2],
                                                   std::max(std::abs(face[0]), std::abs(face[1])),
                                                   p.low[2] - shapes.low[2],
                                                   p.high[2] - shapes.low[2],
                                                   shapes.high[2] - p.high[2],
                                                   extent[2],
                                                   extent[2] / size[2],
                                                   length,
                                                   length / scene_length,
                                                   p.area_m2 / rectangle,
                                                   behind,
                                                   before,
                                                   near,
                                                   depth_behind,
                                                   depth_before,
                                                   rim,
                                                   center_rim,
                                                   back[0],
                                                   back[1],
                                                   back[2],
                                                   front[0],
                                                   front[1],
                                                   front[2],
                                                   down[0],
                                                   down[1],
                                                   down[2],
                                                   up[0],
                                                   up[1],
                                                   up[2],
                                                   level_below,
                                                   level_above,
                                                   size[2],
                                                   std::max(size[0], size[1]),
                                                   std::min(size[0], size[1]),
                                                   shapes.area_m2,
                                                   scene.upright_m2 / shapes.area_m2,
                                                   scene.tallest_upright_m};
        for (std::size_t f = 0; f < row.size(); ++f)
            rows[number * row.size() + f] = static_cast<float>(row[f]);
    });
    return rows;
}

}  // namespace topple::geometry
