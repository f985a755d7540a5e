// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/vectors.h"
#include "geometry/manhattan_normals.h"

namespace topple::geometry {

// The planes that hold a good part of all surface: floors, walls, roofs, ramps.
struct LargePlanes {
    std::vector<bool> holds;  // by normal: whether it lies in one of them
    // How much of the scene lies before them, less what lies behind them, in the mean: 1 in a room,
    // -1 of a closed thing seen from outside, 0 of stairs, or of a floor with nothing on it.
    double enclosing = 0;
};

// directions: of normals, those that surfaces are large across.
LargePlanes find_large_planes(const Surfels& surfels, const WeightedNormals& normals,
                              const std::vector<Vec3>& directions);

// Normals this near to an axis count for planes across it, degrees.
inline constexpr double plane_degrees = 10;

// How the surface lies along an axis that may be vertical.
struct Profile {
    // Shares of all surface that lie in large planes across the axis and face along it / against
    // it.
    double along = 0, against = 0;
    double extent_m = 0;  // of the scene along the axis, without the outer 1 %
    // What tells the axis' ends apart, -1..1, positive where the axis points up:
    double level_facing = 0;  // of level surface between the outermost tenths: tables face up
    // How far below half height slanted surface lies, but for large planes: things lie low.
    double clutter_low = 0;
    double lone_end = 0;  // 1: of floor and ceiling only a floor is there, -1: only a ceiling
    // The same by where level surface lies, whatever it faces: at the lower end alone, or the
    // upper.
    double lone_place = 0;
    // Share of all surface that runs along the axis, as walls and things that stand do, but follows
    // no two directions at right angles: what stands may be turned or round, what lies may not.
    // Large planes do not count: a roof runs along the ridge, and is one surface, not many things.
    double turned = 0;
};
Profile profile_along(const Surfels& surfels, const WeightedNormals& normals,
                      const LargePlanes& planes, const Vec3& axis);

}  // namespace topple::geometry
