// SPDX-License-Identifier: MIT
#pragma once

// Internal to vdb/.
#include <cstdint>
#include <vector>

#include "vdb/grids.h"

namespace topple::vdb {

// Whether a leaf is all seen to be empty, and stored as one value.
bool uniformly_empty(const openvdb::Int32Grid::ConstAccessor& state, const LeafTable::Leaf& leaf);

// The leaves that filling has to look at, ascending: those in which a voxel may be filled, and
// those that its rays cross. All else would be swept to no effect: of a hall, four fifths is what
// lies unseen behind its walls. What is left out changes no filled voxel, for at a leaf that is not
// swept a ray ends as it would beyond it: at nothing known, unless that leaf is uniformly empty.
//   fills    by primitive, whether it takes voxels
//   votes    rays that must hit the same primitive; the ray upwards may suffice
//   lowest   voxels with k below stay as they are and stop rays
std::vector<LeafTable::Leaf> leaves_to_fill(const VoxelScene::Grids& grids,
                                            const std::vector<bool>& fills, unsigned votes,
                                            std::int32_t lowest);

}  // namespace topple::vdb
