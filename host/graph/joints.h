// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/table.h"
#include "geometry/primitive_shapes.h"
#include "geometry/surface_samples.h"
#include "geometry/surface_seams.h"
#include "graph/contact_graph.h"
#include "physics/bodies.h"
#include "topple/kernels/device.h"

namespace topple::graph {

// What the fitted model says of two primitives that are near each other.
struct Joint {
    std::int32_t a = -1, b = -1;  // primitives, a < b
    double log_odds = 0;          // that they are one solid object
};

// A primitive that is surer to be the room's than this is taken for it; others are left to their
// joints.
inline constexpr double surely_shell = 0.9;

// The joints around a primitive look at the same surfaces: they are no independent witnesses, and
// the sum of their log-odds says too much. The same with so much added to each, nats.
std::vector<Joint> biased_joints(std::span<const Joint> joints, double bias);

// How much less sure joints are than the model says, nats, where noise breaks surfaces into more
// fragments than on the scans that it was fitted on. samples: of each primitive of a thing.
double doubt_of_fragments(std::vector<std::size_t> samples);

struct Judged {
    std::vector<Joint> joints;         // of all pairs of joint_features(), sorted by (a, b)
    Table<PrimitiveId, double> shell;  // log-odds that a primitive is the room's
};

// What the fitted models say of joints, and of primitives that they are the room's, amid all
// others, with the doubt above. shell: the same log-odds of each primitive by itself.
Judged judge_joints(device::Device& device, const geometry::SurfaceSamples& samples,
                    const geometry::PrimitiveShapes& shapes, const ContactGraph& contacts,
                    TableView<PrimitiveId, physics::MassProperties> bodies,
                    const geometry::SurfaceSeams& seams, TableView<PrimitiveId, double> shell);

}  // namespace topple::graph
