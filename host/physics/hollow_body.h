// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/solid_scene.h"
#include "physics/bodies.h"
#include "physics/inertia.h"

namespace topple::physics {

// What of an object is within `wall_m` of its surface: the shell that it is where it is hollow,
// closed on all sides. Grid frame.
struct HollowBody {
    std::vector<double> volume_m3;  // of the shell, by primitive of the object
    std::vector<Vec3> center;       // of that
    Symmetric inertia_m5{};         // of the shell's volume, about its centre
};

// primitives: of the object, ascending. How deep a voxel's middle lies is measured to the nearest
// voxel of the surface and as far as that is solid; of voxels that the shell ends in it takes the
// share by depth.
HollowBody hollow_body(const SolidScene& solids, std::span<const std::int32_t> primitives,
                       double wall_m);

}  // namespace topple::physics
