// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/surfels.h"

namespace topple::geometry {

inline constexpr double horizontal_cos = 0.9;  // within 26 degrees of up: allows for noisy normals
inline constexpr double vertical_sin = 0.3;    // within 17 degrees of level
inline constexpr double flat = 0.85;           // of a plane, the least length of the mean normal
// A smaller plane bounds no room.
inline constexpr double wall_area_m2 = 0.3;
// Ceilings of a building hang no lower above the floor, and its walls end no lower below them.
inline constexpr double lowest_ceiling_m = 2.0, below_ceiling_m = 0.2;

inline double component(const Vec3& a, double x, double y, double z) {
    return a[0] * x + a[1] * y + a[2] * z;
}

// Area-weighted mean plane of one primitive: point, normal, and how much of it agrees.
struct Face {
    double area_m2 = 0;  // of surfels whose normal agrees with the mean
    double nx = 0, ny = 0, nz = 0, px = 0, py = 0, pz = 0;
    double flatness = 0;  // length of the mean normal: 1 for a plane, less for a box
    double lowest_m = INFINITY, highest_m = -INFINITY;  // along up
    double height_m(const Vec3& up) const { return component(up, px, py, pz); }
    // Along up: 1 looks up, 0 is upright, -1 looks down.
    double level(const Vec3& up) const { return component(up, nx, ny, nz); }
};

// label: of each surfel, below `count` or -1.
std::vector<Face> faces(const Surfels& surfels, const std::vector<std::int32_t>& label,
                        std::size_t count, const Vec3& up);

// Of the highest large plane that looks down from above a person's head, but below top_m; infinite
// where there is none.
double ceiling_height(const std::vector<Face>& faces, const Vec3& up, double floor_m, double top_m);

}  // namespace topple::geometry
