// SPDX-License-Identifier: MIT
#include "pipeline/solid_parts.h"

namespace topple {

SolidParts solid_parts(const GeometryStage& geometry, const VoxelStage& voxels) {
    SolidParts out;
    out.frame = geometry.frame;
    out.model = geometry.primitives.model;
    out.shell_log_odds = geometry.shell_log_odds;
    out.samples = geometry.samples;
    out.points.resize(out.model.size());
    for (const std::int32_t p : geometry.primitive_of_point) {
        if (p >= 0) ++out.points[static_cast<std::size_t>(p)];
    }
    out.seams = surface_seams(geometry);
    out.solids = voxels.solids;
    return out;
}

}  // namespace topple
