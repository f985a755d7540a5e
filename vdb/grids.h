// SPDX-License-Identifier: MIT
#pragma once

// Internal to vdb/: what stands behind VoxelScene. Only vdb's own sources include this.
#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vdb/leaf_table.h"
#include "vdb/voxel_scene.h"

namespace topple::vdb {

// Of the scene's bounds.
inline constexpr std::uint64_t max_leaves = std::uint64_t{1} << 23;

// Throws Error(usage) unless voxels have a size and the grid is turned, not sheared.
void check(const VoxelFrame& frame);

using StateTree = openvdb::Int32Tree;
using StateLeaf = StateTree::LeafNodeType;

// OpenVDB's own end of a tree gathers its nodes in an array first; where there is no memory for
// that, it ends the program. The root's needs none.
template <class Tree>
void clear_tree(Tree& tree) noexcept {
    tree.root().clear();
}

// A grid whose tree ends with it.
template <class Grid>
struct ShortLived {
    explicit ShortLived(const typename Grid::ValueType& background)
        : grid(Grid::create(background)) {}
    ~ShortLived() { clear_tree(grid->tree()); }
    ShortLived(const ShortLived&) = delete;
    ShortLived& operator=(const ShortLived&) = delete;

    typename Grid::Ptr grid;
};

inline openvdb::Coord origin_of(const LeafTable::Leaf& leaf) {
    return {leaf[0] * 8, leaf[1] * 8, leaf[2] * 8};
}
inline LeafTable::Leaf leaf_of(const openvdb::Coord& voxel) {
    return {voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3};
}

inline openvdb::Coord coord(const Voxel& at) {
    return {at[0], at[1], at[2]};
}

// Calls use(leaf, offset, voxel) for all voxels of sorted leaves, in the order of (i, j, k).
template <class Use>
void in_voxel_order(const std::vector<LeafTable::Leaf>& leaves, const Use& use) {
    // Planes of voxels across all leaves of one x, then rows across all of one (x, y).
    const auto end_of = [&](std::size_t first, int axes) {
        std::size_t end = first;
        while (end < leaves.size() &&
               std::equal(leaves[end].begin(), leaves[end].begin() + axes, leaves[first].begin()))
            ++end;
        return end;
    };
    for (std::size_t slab = 0, next_slab; slab < leaves.size(); slab = next_slab) {
        next_slab = end_of(slab, 1);
        for (std::int32_t x = 0; x < 8; ++x) {
            for (std::size_t row = slab, next_row; row < next_slab; row = next_row) {
                next_row = end_of(row, 2);
                for (std::int32_t y = 0; y < 8; ++y) {
                    for (std::size_t n = row; n < next_row; ++n) {
                        for (std::int32_t z = 0; z < 8; ++z)
                            use(n, static_cast<std::size_t>(x << 6 | y << 3 | z),
                                Voxel{leaves[n][0] * 8 + x, leaves[n][1] * 8 + y,
                                      leaves[n][2] * 8 + z});
                    }
                }
            }
        }
    }
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
    Grids() = default;
    ~Grids() {
        if (state) clear_tree(state->tree());
        if (primitive) clear_tree(primitive->tree());
        clear_tree(points);
        for (const auto& field : fields) clear_tree(field.second->tree());
    }
    Grids(const Grids&) = delete;
    Grids& operator=(const Grids&) = delete;

    VoxelFrame frame;
    LeafTable leaves;
    // Values are State's; active voxels are the solid ones; background is invisible, so that only
    // what was seen takes memory. Empty leaves are inactive tiles.
    openvdb::Int32Grid::Ptr state;
    // Label of the voxels that hold points or were completed. Where carving took a point's voxel
    // away the label stays, but counts only where `state` is active.
    openvdb::Int32Grid::Ptr primitive;
    openvdb::MaskTree points;  // voxels that hold points
    // Of those within the bounds whose seen side is known: index of the leaf * 512 + voxel,
    // ascending.
    std::vector<std::uint64_t> sided;
    std::vector<std::uint8_t> seen_side;
    std::vector<std::int32_t> object_of_primitive;
    std::vector<std::pair<std::string, openvdb::FloatGrid::Ptr>> fields;
    Evidence evidence;

    // Takes leaves beyond the scene's bounds into the table.
    void take_in(std::span<const LeafTable::Leaf> changed);
    // Index to input frame: voxel (i, j, k)'s centre.
    openvdb::math::Transform::Ptr transform() const;
};

}  // namespace topple::vdb
