// SPDX-License-Identifier: MIT
#include "solids/solid_parts.h"

namespace topple {

Unseen unseen_of(const SolidParts& parts) {
    if (!parts.sensed) return {};
    return [&volume = *parts.sensed](std::int32_t i, std::int32_t j, std::int32_t k) {
        return volume.state_at(i, j, k) == vdb::State::invisible;
    };
}

SolidParts solid_parts(const Surfaces& geometry, const Volume& voxels) {
    SolidParts out;
    out.frame = geometry.frame;
    out.model = left_of(voxels.number, geometry.primitives.model);
    out.shell_log_odds = left_of(voxels.number, geometry.shell_log_odds);
    out.samples = numbered(geometry.samples, voxels.number);
    out.points.resize(out.model.size());
    for (const std::int32_t p : numbered(geometry.primitive_of_point, voxels.number)) {
        if (p >= 0) ++out.points[p];
    }
    out.seams = surface_seams(geometry, voxels.number);
    out.solids = voxels.solids;
    if (voxels.by_sensors) out.sensed = voxels.scene;
    return out;
}

}  // namespace topple
