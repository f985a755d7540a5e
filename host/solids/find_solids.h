// SPDX-License-Identifier: MIT
#pragma once

#include "device/stage_clock.h"
#include "points/observation.h"
#include "solids/surfaces.h"
#include "solids/volume.h"
#include "topple/kernels/device.h"
#include "topple/parse.h"

// Section 2 of the paper: from points to primitives and their solids.
namespace topple {

struct SurfacesAndVolume {
    Surfaces geometry;
    Volume voxels;
};

// Free space is carved beside the finding of primitives, where that is possible.
SurfacesAndVolume find_solids(device::Device& device, const Observation& input, double voxel_m,
                              const ParseOptions& options, StageClock& stage,
                              SolidDetail detail = SolidDetail::within_voxels);

}  // namespace topple
