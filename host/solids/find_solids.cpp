// SPDX-License-Identifier: MIT
#include "solids/find_solids.h"

#include <utility>

#include "points/work_check.h"
#include "solids/space_carving.h"

namespace topple {

SurfacesAndVolume find_solids(device::Device& device, const Observation& input, double voxel_m,
                              const ParseOptions& options, StageClock& stage, SolidDetail detail) {
    FramedSurfels surfels = find_surfels(device, input, options, stage);
    if (Budget* budget = Budget::current()) check_work(input, surfels, voxel_m, *budget);
    SpaceCarving carving(device, input, {voxel_m, surfels.frame.axes});
    SurfacesAndVolume out;
    out.geometry = find_primitives(device, input, std::move(surfels), stage);       // 2.1
    out.voxels = fill_volume(device, input, out.geometry, carving, stage, detail);  // 2.2
    // From here on in the input's frame.
    out.geometry.frame.origin_m = input.origin_m;
    out.voxels.scene->set_origin(input.origin_m);
    return out;
}

}  // namespace topple
