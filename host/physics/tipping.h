// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "topple/input.h"

// Rigid tipping over the edges of a support polygon, in the horizontal plane. Grid frame, metres.
namespace topple::physics {

// Where a centre of mass stands in a convex polygon of contact.
struct Footing {
    double margin_m = 0;  // signed distance to the polygon's border, > 0 inside
    Vec3 away{};  // outside: unit direction in which it falls; zero if it stands on the border
    struct Edge {
        double distance_m = 0;  // of the centre of mass from the edge's line
        Vec3 outward{};         // unit
        std::array<std::array<double, 2>, 2> ends{};
    };
    std::vector<Edge> edges;                         // inside only
    std::array<std::array<double, 2>, 2> nearest{};  // ends of the nearest edge, or the one point
};
// polygon: counter-clockwise, convex, at least one point; one or two points, or points on a line,
// give a footing without an inside.
Footing footing(std::span<const std::array<double, 2>> polygon, double x, double y);

// How far a centre of mass that is so high rises until it stands over an edge that is so far away,
// level.
double rise_over_edge_m(double height_m, double distance_m);

// How far under it, level, an edge is from a centre of mass `height_m` above it that rises by so
// much until it stands over the edge: the inverse of that.
double edge_distance_m(double rise_m, double height_m);

// Convex hull of points, counter-clockwise, strict corners only, from the lowest (x, y) on.
std::vector<std::array<double, 2>> convex_polygon(std::vector<std::array<double, 2>> points);

// Least width of a convex polygon: over its edges, the reach of the corner furthest from the edge.
double least_width_m(std::span<const std::array<double, 2>> polygon);

}  // namespace topple::physics
