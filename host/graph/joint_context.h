// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/table.h"
#include "geometry/primitive_shapes.h"
#include "graph/joint_features.h"
#include "topple/kernels/device.h"

namespace topple::graph {

// Log-odds of the joints of a table, in its order, and of primitives that they are the room's.
struct JointOdds {
    std::vector<double> joints;
    Table<PrimitiveId, double> shell;
};

// The same amid all other joints: a network passes messages along the joints for some rounds
// (Gilmer et al. 2017), so that what a seat is to its back is told by the legs, too. Its weights
// were fitted on scans of others' models (fitted/context.model.json); its layers are kernels, whose
// sums have a fixed order: the same bits on any device. `alone`: of each joint and primitive by
// itself.
JointOdds in_context(device::Device& device, const geometry::PrimitiveShapes& shapes,
                     const JointTable& table, const JointOdds& alone);

}  // namespace topple::graph
