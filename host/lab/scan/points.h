// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "lab/scan/sensor.h"

namespace topple::scenes {

struct ColouredPoint {
    Vec3 at{};
    Colour colour{};
};

// The mean of the points of each cube of this edge that holds at least `least` of them, ordered by
// cube.
std::vector<ColouredPoint> fused(const std::vector<ColouredPoint>& points, double edge,
                                 std::uint32_t least);

// Each point moved by `share` of the way to the mean of those of `among` within `radius`.
void smooth_among(std::vector<ColouredPoint>& points, const std::vector<ColouredPoint>& among,
                  double radius, double share);

// Leaves out what lies within balls of random radii around `count` of the points.
void tear_holes(std::vector<ColouredPoint>& points, unsigned count, double least_radius,
                double most_radius, Random& random);

struct LabelledPoint {
    Vec3 at{};
    std::int32_t object = -1;
};
// The first point of each object in each cube: of object 0 in cubes of `building`, of the others
// in cubes of `things`.
std::vector<LabelledPoint> thinned(const std::vector<LabelledPoint>& points, double things,
                                   double building);

// The object of the truth's point that is nearest to each place within `radius`, the first of
// equals; -1 where there is none.
std::vector<std::int32_t> nearest_objects(const std::vector<Vec3>& places,
                                          const std::vector<LabelledPoint>& truth, double radius);

}  // namespace topple::scenes
