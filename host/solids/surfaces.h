// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "device/stage_clock.h"
#include "geometry/framed_surfels.h"
#include "geometry/manhattan.h"
#include "geometry/segmentation.h"
#include "geometry/shell.h"
#include "geometry/surface_samples.h"
#include "geometry/surface_seams.h"
#include "geometry/surfels.h"
#include "points/observation.h"
#include "topple/kernels/device.h"

// Section 2.1 of the paper: from points to primitives.
namespace topple {

struct Surfaces {
    geometry::Surfels surfels;
    geometry::SceneFrame frame;
    geometry::PrimitiveSet primitives;
    geometry::SurfaceSamples samples;
    std::vector<Role> role;                     // by primitive
    std::vector<double> shell_log_odds;         // by primitive, that it is the room's
    std::vector<geometry::StoreyHint> storeys;  // of a building; none of a room
    std::vector<std::int32_t> region_of_point, primitive_of_point;
};

FramedSurfels find_surfels(device::Device& device, const Observation& input,
                           const ParseOptions& options, StageClock& stage);

// Of the device it takes the threads alone.
Surfaces find_primitives(device::Device& device, const Observation& input, FramedSurfels surfels,
                         StageClock& stage);

// The seen surface inside solids and at their seams; of all surfels, or of those that count. A pair
// of neighbours counts with the first of the two. number: the solid of each primitive, -1: none.
geometry::SurfaceSeams surface_seams(const Surfaces& geometry, std::span<const std::int32_t> number,
                                     const std::function<bool(std::size_t)>& counts = nullptr);

}  // namespace topple
