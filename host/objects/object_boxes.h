// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/object_of.h"
#include "core/solid_scene.h"

namespace topple {

// Of an object along the grid's axes, metres. Where nothing of it is solid the size is 0 and the
// middle NaN.
struct ObjectBox {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    Vec3 middle_m{none, none, none}, size_m{};
    double top_m() const { return middle_m[2] + size_m[2] / 2; }
};

// Of each of so many objects the box from end to end of what of it is solid, within voxels as far
// as what bounds it there is known, else to a voxel.
std::vector<ObjectBox> object_boxes(const SolidScene& solids, ObjectOf object_of,
                                    std::size_t objects);

}  // namespace topple
