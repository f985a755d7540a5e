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

// Rays from a primitive that say what is around it.
constexpr std::size_t most_rays = 120;

struct Scene {
    const PrimitiveShapes& shapes;
    double spacing_m = 0;  // of the samples
    double largest_m2 = 0, upright_m2 = 0, tallest_upright_m = 0;
    Scene(const PrimitiveShapes& all, double spacing) : shapes(all), spacing_m(spacing) {
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

// What lies about a primitive, and what it fills of the rectangle round it.
struct Surroundings {
    double length_m = 0, scene_length_m = 0, rectangle_m2 = 0;
    std::array<double, 5> sides{};
    double rim_m = INFINITY, center_rim_m = INFINITY;  // from the sides of the scene's bounds
    std::array<float, 3> back{}, front{}, down{}, up{};
    std::array<double, 2> levels{};
};

Surroundings surroundings(const SurfaceSamples& s, const Scene& scene,
                          std::span<const Vector3d> some, const PrimitiveShape& p,
                          const SightLines& lines) {
    Surroundings out;
    const Vector3d face = p.face(), extent = p.high - p.low, size = scene.size();
    // What stands upright is asked what is behind it at its own height.
    const bool upright = std::abs(face[2]) < 0.5;
    const Vector3d ahead =
        upright ? Vector3d(face[0], face[1], 0).normalized() : Vector3d(0, 0, face[2] > 0 ? 1 : -1);
    const Vector3d along = upright ? Vector3d(-ahead[1], ahead[0], 0) : Vector3d(1, 0, 0);
    double low = INFINITY, high = -INFINITY;
    for (std::size_t n = p.first; n < p.last; ++n) {
        const double t = along[0] * s.x[n] + along[1] * s.y[n];
        low = std::min(low, t);
        high = std::max(high, t);
    }
    out.length_m = p.samples() ? high - low : 0;
    out.scene_length_m = std::abs(along[0]) * size[0] + std::abs(along[1]) * size[1];
    out.rectangle_m2 = upright ? (out.length_m + s.spacing_m) * (extent[2] + s.spacing_m)
                               : (extent[0] + s.spacing_m) * (extent[1] + s.spacing_m);
    out.sides = sides(some, s.spacing_m, p, face);
    const PrimitiveShapes& all = scene.shapes;
    for (Eigen::Index a = 0; a < 2; ++a) {
        out.rim_m = std::min({out.rim_m, p.low[a] - all.low[a], all.high[a] - p.high[a]});
        out.center_rim_m =
            std::min({out.center_rim_m, p.center[a] - all.low[a], all.high[a] - p.center[a]});
    }
    out.back = met<3>(s, p, lines, -ahead, {0.3, 1, 4});
    out.front = met<3>(s, p, lines, ahead, {0.3, 1, 4});
    out.down = met<3>(s, p, lines, {0, 0, -1}, {0.25, 0.6, 3});
    out.up = met<3>(s, p, lines, {0, 0, 1}, {0.25, 1, 4});
    out.levels = levels(all, p);
    return out;
}

// A value of a row with its name, so that the two can't part.
struct Feature {
    std::string_view name;
    double value;
};

auto features(const Scene& scene, const PrimitiveShape& p, const Surroundings& around) {
    const PrimitiveShapes& all = scene.shapes;
    const Vector3d face = p.face(), size = scene.size();
    const double height = p.high[2] - p.low[2];
    return std::to_array<Feature>({
        {"edge", scene.spacing_m},
        {"log_area", std::log(p.area_m2 + 1e-4)},
        {"area_share", p.area_m2 / all.area_m2},
        {"area_of_largest", p.area_m2 / scene.largest_m2},
        {"thickness", p.spread[0]},
        {"width", p.spread[1]},
        {"length", p.spread[2]},
        {"thickness_over_edge", p.spread[0] / scene.spacing_m},
        {"up_share", p.up_share},
        {"down_share", p.down_share},
        {"side_share", p.side_share},
        {"normal_length", p.normal.norm()},
        {"face_z", face[2]},
        {"face_aligned", std::max(std::abs(face[0]), std::abs(face[1]))},
        {"low_above_floor", p.low[2] - all.low[2]},
        {"high_above_floor", p.high[2] - all.low[2]},
        {"below_top", all.high[2] - p.high[2]},
        {"height", height},
        {"height_share", height / size[2]},
        {"level_length", around.length_m},
        {"length_share", around.length_m / around.scene_length_m},
        {"filled", p.area_m2 / around.rectangle_m2},
        {"behind_share", around.sides[0]},
        {"before_share", around.sides[1]},
        {"behind_near_share", around.sides[2]},
        {"depth_behind", around.sides[3]},
        {"depth_before", around.sides[4]},
        {"rim_distance", around.rim_m},
        {"center_rim", around.center_rim_m},
        {"back_met_30", around.back[0]},
        {"back_met_100", around.back[1]},
        {"back_met_400", around.back[2]},
        {"front_met_30", around.front[0]},
        {"front_met_100", around.front[1]},
        {"front_met_400", around.front[2]},
        {"down_met_20", around.down[0]},
        {"down_met_60", around.down[1]},
        {"down_met_300", around.down[2]},
        {"up_met_20", around.up[0]},
        {"up_met_100", around.up[1]},
        {"up_met_400", around.up[2]},
        {"level_below", around.levels[0]},
        {"level_above", around.levels[1]},
        {"scene_height", size[2]},
        {"scene_length", std::max(size[0], size[1])},
        {"scene_width", std::min(size[0], size[1])},
        {"scene_area", all.area_m2},
        {"upright_share", scene.upright_m2 / all.area_m2},
        {"tallest_upright", scene.tallest_upright_m},
    });
}

}  // namespace

std::span<const std::string_view> shell_feature_names() {
    static const std::vector<std::string_view> names = [] {
        const PrimitiveShapes nothing;
        std::vector<std::string_view> out;
        for (const Feature& f : features({nothing, 1}, {}, {})) out.push_back(f.name);
        return out;
    }();
    return names;
}

std::vector<float> shell_features(const SurfaceSamples& s, const PrimitiveShapes& shapes,
                                  const SightLines& lines, ThreadPool& threads) {
    const Scene scene(shapes, s.spacing_m);
    std::vector<Vector3d> some;
    const std::size_t step = std::max<std::size_t>(1, s.size() / 4000);
    for (std::size_t n = 0; n < s.size(); n += step) some.emplace_back(s.x[n], s.y[n], s.z[n]);
    const std::size_t width = shell_feature_names().size();
    std::vector<float> rows(shapes.of.size() * width);
    threads.each(shapes.of.size(), 4, [&](std::size_t number) {
        const PrimitiveShape& p = shapes.of[number];
        float* value = &rows[number * width];
        for (const Feature& f : features(scene, p, surroundings(s, scene, some, p, lines)))
            *value++ = static_cast<float>(f.value);
    });
    return rows;
}

}  // namespace topple::geometry
