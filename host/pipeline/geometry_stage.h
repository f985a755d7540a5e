// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "device/device.h"
#include "geometry/manhattan.h"
#include "geometry/segmentation.h"
#include "geometry/shell.h"
#include "geometry/surface_samples.h"
#include "geometry/surfels.h"
#include "graph/surface_seams.h"
#include "pipeline/ingest.h"
#include "pipeline/stage_clock.h"

// Section 2.1 of the paper: from points to primitives.
namespace topple {

struct GeometryStage {
    geometry::Surfels surfels;
    geometry::SceneFrame frame;
    geometry::PrimitiveSet primitives;
    geometry::SurfaceSamples samples;
    std::vector<Role> role;                     // by primitive
    std::vector<double> shell_log_odds;         // by primitive, that it is the room's
    std::vector<geometry::StoreyHint> storeys;  // of a building; none of a room
    std::vector<std::int32_t> region_of_point, primitive_of_point;
};

GeometryStage find_primitives(device::Device& device, const Ingested& input,
                              const ParseOptions& options, StageClock& stage);

// Drops the primitives for which `keep` is false and renumbers the others in their order. Returns
// the new number of each, -1 for the dropped.
std::vector<std::int32_t> keep_primitives(GeometryStage& geometry, const std::vector<bool>& keep);

// The seen surface inside primitives and at their seams; of all surfels, or of those that count. A
// pair of neighbours counts with the first of the two.
graph::SurfaceSeams surface_seams(const GeometryStage& geometry,
                                  const std::function<bool(std::size_t)>& counts = nullptr);

}  // namespace topple
