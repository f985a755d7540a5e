// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "physics/slide_map.h"
#include "physics/sliding.h"

namespace topple::physics {
namespace {

// How far it is from a point to the cell [i, i + 1] x [j, j + 1], along a way that meets it.
double entered_at(const std::array<double, 2>& from, const std::array<double, 2>& way,
                  std::int32_t i, std::int32_t j) {
    double at = 0;
    const std::array<std::int32_t, 2> cell{i, j};
    for (std::size_t a = 0; a < 2; ++a) {
        if (way[a] == 0) continue;
        const double border = cell[a] + (way[a] > 0 ? 0.0 : 1.0);
        at = std::max(at, (border - from[a]) / way[a]);
    }
    return at;
}

StraightSlide straight_slide(SlideMap& map, const std::array<double, 2>& center,
                             const std::array<double, 2>& way) {
    for (double at = 0; at < map.radius() - 1; at += 0.5) {
        const auto i = static_cast<std::int32_t>(std::floor(center[0] + at * way[0]));
        const auto j = static_cast<std::int32_t>(std::floor(center[1] + at * way[1]));
        if (map.falls(i, j)) {
            if (!(map.drop_m(i, j) > 0)) return {};
            return {entered_at(center, way, i, j) * map.voxel_m(), map.drop_m(i, j)};
        }
        const bool started = i == map.start_i() && j == map.start_j();
        if (!started && !map.passable(i, j)) return {};
    }
    return {};
}

// From column a and row b of the places.
StraightSlide straight_from(const Landscape::Places& places, std::int32_t a, std::int32_t b,
                            const std::array<double, 2>& way, double weight_N) {
    for (double at = 0.5;; at += 0.5) {
        const auto x = static_cast<std::int32_t>(std::lround(a + at * way[0]));
        const auto y = static_cast<std::int32_t>(std::lround(b + at * way[1]));
        if (x < 0 || y < 0 || x >= places.side || y >= places.side) return {};
        const float energy = places.energy_J[y * places.side + x];
        if (!std::isfinite(energy)) return {};
        if (energy < 0)
            return {std::max(0.0, at - 1) * places.step_m, weight_N > 0 ? -energy / weight_N : 0};
    }
}

}  // namespace

std::vector<StraightSlide> straight_slides(SlideMap& map, const std::array<double, 2>& center,
                                           std::span<const std::array<double, 2>> ways) {
    std::vector<StraightSlide> out;
    for (const auto& way : ways) out.push_back(straight_slide(map, center, way));
    return out;
}

SlideElsewhere slide_elsewhere(const Landscape::Places& places, std::int32_t a, std::int32_t b,
                               double mass_kg, double friction,
                               std::span<const std::array<double, 2>> ways) {
    const auto energy = [&](std::int32_t x, std::int32_t y) {
        return places.energy_J[y * places.side + x];
    };
    SlideElsewhere out;
    const float here = energy(a, b);
    out.reachable = std::isfinite(here) && here >= 0;
    if (!out.reachable) return out;
    const double weight = mass_kg * gravity;
    for (const auto& way : ways)
        out.slide.straight.push_back(straight_from(places, a, b, way, weight));
    double nearest = std::numeric_limits<double>::infinity();
    for (std::int32_t y = 0; y < places.side; ++y) {
        for (std::int32_t x = 0; x < places.side; ++x) {
            if (!(energy(x, y) < 0)) continue;
            const double way = places.step_m * std::hypot(x - a, y - b);
            if (way >= nearest) continue;
            nearest = way;
            out.slide.released_J = -double{energy(x, y)};
            out.slide.direction = {places.step_m * (x - a) / way, places.step_m * (y - b) / way, 0};
        }
    }
    if (!std::isfinite(nearest) || !(weight > 0)) return out;
    out.slide.found = true;
    nearest = std::max(0.0, nearest - places.step_m);
    out.slide.distance_m = nearest;
    out.slide.drop_m = out.slide.released_J / weight;
    out.slide.absorbed_J = friction * weight * nearest;
    return out;
}

}  // namespace topple::physics
