// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "export/sim_scene.h"

// A body is `object_ID` for each object, free where it may move, or `pad_N` for each pad. Its parts
// collide, as boxes, cylinders or spheres where they are such; what is seen of it collides with
// nothing. An earlier export is replaced, see ExportFolder. Throw Error(input).
namespace topple::exports {

// MuJoCo's format, as scene.xml in a folder: a geom for each part, and one for what is seen. With
// scene_asleep.xml, in which what is at rest sleeps.
void write_mjcf(const std::filesystem::path& folder, const SimScene& scene);

// As scene.urdf in a folder: one tree, of which each body is a link at a joint to `world`, floating
// or fixed. And each body by itself, as scene_urdf/object_ID.urdf, for simulators that know no
// floating joints.
void write_urdf(const std::filesystem::path& folder, const SimScene& scene);

// SDF 1.7, which Gazebo reads, as scene.sdf in a folder: a world with a model for each body, static
// where it is fixed.
void write_sdf(const std::filesystem::path& folder, const SimScene& scene);

// One file of USD as text, with the schemas of UsdPhysics: a prim /World/object_ID for each body,
// rigid where it may move; below it its surface, for renderers, and its parts. The file's name ends
// in .usda, or Error(usage) is thrown.
void write_usd(const std::filesystem::path& file, const SimScene& scene);

}  // namespace topple::exports
