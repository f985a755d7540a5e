// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/table.h"
#include "core/thread_pool.h"
#include "geometry/primitive_shapes.h"
#include "geometry/surface_samples.h"
#include "geometry/surface_seams.h"
#include "graph/contact_graph.h"
#include "physics/bodies.h"

namespace topple::graph {

// What tells whether two primitives that are near each other are one solid object, as numbers:
// lengths in metres or over a length of the thing's own, angles as cosines; nothing is counted in
// voxels. "small" and "big" are the two by their seen area. The names are those of the fitted model
// (fitted/).
std::span<const std::string_view> joint_feature_names();

struct JointTable {
    std::vector<std::pair<std::int32_t, std::int32_t>> pairs;  // (a, b), a < b, sorted
    std::vector<float> rows;  // one after the other, in the order of the names; NaN: not known
};

// A row for each two primitives whose surfaces come near each other or whose solids touch.
// shell: by primitive, the probability that it is the room's.
JointTable joint_features(const geometry::SurfaceSamples& samples,
                          const geometry::PrimitiveShapes& shapes, const ContactGraph& contacts,
                          TableView<PrimitiveId, physics::MassProperties> bodies,
                          const geometry::SurfaceSeams& seams, TableView<PrimitiveId, float> shell,
                          ThreadPool& threads);

}  // namespace topple::graph
