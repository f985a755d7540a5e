// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/basis.h"
#include "core/solid_scene.h"
#include "lab/solids/scene.h"
#include "vdb/voxel_scene.h"

// How often what a rule takes to be solid is solid: what core/basis.h has its probabilities from.
namespace topple::evaluation {

struct BasisCounts {
    struct Count {
        std::uint64_t right = 0, of = 0;
    };
    std::array<Count, basis_count> basis{};
};

// Adds the solid voxels of a room, judged as scenes::volume_score does for its precision.
void add_voxels(const scenes::World& truth, const SolidScene& solids, const vdb::VoxelFrame& frame,
                BasisCounts& counts);

std::string table_of(const BasisCounts& counts);

}  // namespace topple::evaluation
