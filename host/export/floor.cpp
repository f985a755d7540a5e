// SPDX-License-Identifier: MIT
#include "export/floor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/infinity.h"

namespace topple::exports {
namespace {

// What rises less is no obstacle; what hangs higher is none either.
constexpr double step_m = 0.01, headroom_m = 1.8;

double beside(double x, double low, double high) {
    return std::max({low - x, x - high, 0.0});
}

// What a robot that stands on the floor may run into.
std::vector<const ConvexPart*> obstacles(const std::vector<Body>& bodies, double top) {
    std::vector<const ConvexPart*> out;
    for (const Body& body : bodies)
        for (const ConvexPart& part : body.parts)
            if (part.high[2] > top + step_m && part.low[2] < top + headroom_m) out.push_back(&part);
    return out;
}

}  // namespace

void widen_floor(ConvexPart& floor, const std::vector<Body>& bodies, double voxel_m) {
    constexpr double near_m = 0.3;
    const double top = floor.high[2];
    std::vector<Vec3> points = floor.corner;
    for (const Body& body : bodies) {
        for (const ConvexPart& part : body.parts) {
            if (part.low[2] < top - 2 * voxel_m || part.low[2] > top + near_m) continue;
            for (const Vec3& c : part.corner) {
                points.push_back({c[0], c[1], top});
                points.push_back({c[0], c[1], floor.low[2]});
            }
        }
    }
    if (auto wide = reshaped(floor, points)) floor = *std::move(wide);
}

std::optional<FreePlace> free_place(const ConvexPart& floor, const std::vector<Body>& bodies) {
    constexpr double finest_m = 0.1;
    constexpr double most_places = 1e4;
    if (floor.solid.empty()) return std::nullopt;
    const double width = floor.high[0] - floor.low[0], depth = floor.high[1] - floor.low[1];
    const double apart_m = std::max(finest_m, std::sqrt(width * depth / most_places));
    // Samples of what was seen lie about so far apart.
    const double seen_m =
        2 * std::sqrt(width * depth / static_cast<double>(floor.solid.size())) + finest_m;
    const std::vector<const ConvexPart*> around = obstacles(bodies, floor.high[2]);
    std::optional<FreePlace> best;
    for (double y = floor.low[1] + apart_m / 2; y < floor.high[1]; y += apart_m) {
        for (double x = floor.low[0] + apart_m / 2; x < floor.high[0]; x += apart_m) {
            const double least = best ? best->radius_m : 0;
            // To the floor's end.
            double radius = physics::infinity;
            for (const HalfSpace& side : floor.face)
                if (std::abs(side.normal[2]) < 0.5)
                    radius =
                        std::min(radius, side.offset_m - side.normal[0] * x - side.normal[1] * y -
                                             side.normal[2] * floor.high[2]);
            if (!(radius > least)) continue;
            for (const ConvexPart* part : around) {
                radius = std::min(radius, std::hypot(beside(x, part->low[0], part->high[0]),
                                                     beside(y, part->low[1], part->high[1])));
                if (radius <= least) break;
            }
            if (radius <= least) continue;
            const bool seen = std::ranges::any_of(floor.solid, [&](const Vec3& p) {
                return std::hypot(p[0] - x, p[1] - y) <= seen_m;
            });
            if (seen) best = FreePlace{{x, y, floor.high[2]}, radius};
        }
    }
    return best;
}

}  // namespace topple::exports
