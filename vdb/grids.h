// SPDX-License-Identifier: MIT
#pragma once

// Internal to vdb/: what stands behind VoxelScene. Only vdb's own sources include this.
#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "vdb/leaf_table.h"
#include "vdb/voxel_scene.h"

namespace topple::vdb {

using StateTree = openvdb::Int32Tree;
using StateLeaf = StateTree::LeafNodeType;

inline openvdb::Coord origin_of(const LeafTable::Leaf& leaf) {
    return {leaf[0] * 8, leaf[1] * 8, leaf[2] * 8};
}
inline LeafTable::Leaf leaf_of(const openvdb::Coord& voxel) {
    return {voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3};
}

// What the frames have said so far. Counts of frames; a leaf's own count adds to its voxels'.
struct Evidence {
    enum class Kind : std::uint8_t { invisible, empty, detailed };
    std::vector<Kind> kind;                          // by leaf of the table
    std::vector<std::uint16_t> front;                // frames that see through the whole leaf
    std::vector<std::int32_t> slot;                  // where its voxels' counts lie; -1: all zero
    std::vector<std::vector<std::uint32_t>> voxels;  // by slot, as kernel carve counts them
    std::vector<std::int32_t> free_slots;
};

struct VoxelScene::Grids {
    VoxelFrame frame;
    LeafTable leaves;
    // Values are State's; active voxels are the solid ones; background is invisible, so that only
    // what was seen takes memory. Empty leaves are inactive tiles.
    openvdb::Int32Grid::Ptr state;
    // Label of the voxels that hold points or were completed. Where carving took a point's voxel
    // away the label stays, but counts only where `state` is active.
    openvdb::Int32Grid::Ptr primitive;
    openvdb::MaskTree points;  // voxels that hold points
    std::vector<std::int32_t> object_of_primitive;
    std::vector<std::pair<std::string, openvdb::FloatGrid::Ptr>> fields;
    std::array<std::int32_t, 3> lowest{0, 0, 0}, highest{-1, -1, -1};
    std::uint64_t unplaced = 0;
    Evidence evidence;

    // Makes completed voxels invisible again.
    void clear_completed();
    // Index to input frame: voxel (i, j, k)'s centre.
    openvdb::math::Transform::Ptr transform() const;
};

}  // namespace topple::vdb
