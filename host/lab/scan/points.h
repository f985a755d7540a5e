// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "lab/scan/sensor.h"

namespace topple::scenes {

// Of a pixel's reading of z metres, in the camera's frame.
inline Vec3 place_of(const Intrinsics& k, std::size_t pixel, double z) {
    const double u = static_cast<double>(pixel % k.width), v = static_cast<double>(pixel / k.width);
    return {(u - k.cx) / k.fx * z, (v - k.cy) / k.fy * z, z};
}

struct ColouredPoint {
    Vec3 at{};
    Colour colour{};
};

// A point's cube of some edge, and the point.
struct Keyed {
    std::uint64_t key;
    std::uint32_t at;
    bool operator<(const Keyed& o) const { return key != o.key ? key < o.key : at < o.at; }
};

// The number of a place's cube, along z, then y, then x; those far out share the outermost ones.
std::uint64_t cube(const Vec3& p, double edge);

// Points in the order of their cubes.
template <class Point>
std::vector<Keyed> by_cube(const std::vector<Point>& points, double edge) {
    std::vector<Keyed> order(points.size());
    for (std::size_t n = 0; n < points.size(); ++n)
        order[n] = {cube(points[n].at, edge), static_cast<std::uint32_t>(n)};
    std::sort(order.begin(), order.end());
    return order;
}

// use(those of one cube) for each cube that holds some, in their order.
template <class Point, class Use>
void for_each_cube(const std::vector<Point>& points, double edge, const Use& use) {
    const auto order = by_cube(points, edge);
    for (auto first = order.begin(); first != order.end();) {
        const auto last = std::find_if(first, order.end(),
                                       [&](const Keyed& one) { return one.key != first->key; });
        use(std::span(first, last));
        first = last;
    }
}

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
