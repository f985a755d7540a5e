// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "core/role.h"
#include "core/thread_pool.h"
#include "geometry/storeys.h"
#include "geometry/surface_samples.h"

namespace topple::geometry {

// What of a scene is the room and not a thing in it: floor, walls, ceiling, doors, windows, and
// what is built in.
struct Shell {
    std::vector<double> log_odds;  // by primitive, that it is the room's (fitted/)
    std::vector<Role> role;        // none where that is below 0, else by how it lies
};

// samples: in the scene's frame, sorted by primitive. storeys: each is looked at by itself.
Shell find_shell(const SurfaceSamples& samples, std::size_t primitives, ThreadPool& threads,
                 std::span<const StoreyHint> storeys = {});

}  // namespace topple::geometry
