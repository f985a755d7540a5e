// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lab/furniture/blueprint.h"
#include "topple/input.h"

// Single things whose mass and barrier are known exactly, in an otherwise empty corner of a room.
namespace topple::scenes {

// A thing about its own origin, the middle of its underside; its parts touch and don't overlap.
struct MeasuredShape : Blueprint {
    bool on_table = false;
};
// From 6 cm to 1.8 m: boxes, cylinders, cones, bottles, angles, tables, chairs and lamps.
std::vector<MeasuredShape> measured_shapes();

inline constexpr std::int32_t measured_object = 1;  // its number in the world

// The shape standing at a place and turned by an angle that follow from the seed, on the floor or a
// table's middle, with two walls. Every edge lies askew to a grid of voxels.
World measured_world(const MeasuredShape& shape, std::uint64_t seed);

// What of the surfaces is in view, evenly spaced: all but what touches something.
PointCloud clean_points(const World& world, double spacing_m);

// Poses, camera to room, of someone who walks around the shape with the camera at three heights, as
// far away as its size asks for and the walls allow.
std::vector<Mat4> poses_around(const World& world, unsigned frames);

// Points whose convex hull is that of an object's parts, room frame: corners, and those of a
// polygon of a third of a degree for what is round.
std::vector<Vec3> hull_points(const World& world, std::int32_t object);

}  // namespace topple::scenes
