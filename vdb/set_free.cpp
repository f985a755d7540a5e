// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bitset>
#include <cmath>
#include <string>

#include "topple/error.h"
#include "vdb/grids.h"

// Free space that comes as a map instead of frames.
namespace topple::vdb {
namespace {

constexpr std::uint64_t most_blocks = std::uint64_t{1} << 23;

using Mask = openvdb::MaskTree;

// Whether the map's voxels are the grid's, by index.
bool same_voxels(const VoxelFrame& frame, const SpaceMap& map) {
    bool same = std::abs(map.voxel_m - frame.voxel_m) <= 1e-9 * frame.voxel_m;
    for (std::size_t a = 0; a < 3; ++a) {
        same = same && map.corner_m[a] == 0;
        for (std::size_t d = 0; d < 3; ++d)
            same = same && frame.grid_from_input[a][d] == (a == d ? 1 : 0);
    }
    return same;
}

// One pass of VoxelScene::set_free.
class Freeing {
  public:
    Freeing(VoxelScene::Grids& grids, const SpaceMap& map) : g_(grids), map_(map) {
        for (const SpaceMap::Box& box : map.free) {
            free_.fill(openvdb::CoordBBox(openvdb::Coord(box.low[0], box.low[1], box.low[2]),
                                          openvdb::Coord(box.high[0], box.high[1], box.high[2])),
                       true, true);
        }
    }

    // The map's voxels are the grid's: all of them count, within the scene's bounds and beyond.
    void copy() {
        std::uint64_t blocks = free_.leafCount();
        for (auto tile = tiles(); tile; ++tile) {
            const auto box = tile.getBoundingBox();
            blocks += box.volume() / 512;
        }
        if (blocks > most_blocks) {
            throw Error(ErrorKind::input, "the map's free space holds " + std::to_string(blocks) +
                                              " blocks of 8x8x8 voxels, more than the limit of " +
                                              std::to_string(most_blocks) + "; crop the map");
        }
        for (auto leaf = free_.cbeginLeaf(); leaf; ++leaf) {
            std::bitset<512> free;
            for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) free.set(voxel.pos());
            set(leaf_of(leaf->origin()), free);
        }
        for (auto tile = tiles(); tile; ++tile) {
            const auto box = tile.getBoundingBox();
            const auto low = leaf_of(box.min()), high = leaf_of(box.max());
            for (auto x = low[0]; x <= high[0]; ++x) {
                for (auto y = low[1]; y <= high[1]; ++y) {
                    for (auto z = low[2]; z <= high[2]; ++z)
                        set({x, y, z}, std::bitset<512>().set());
                }
            }
        }
    }

    // The grid's voxels lie otherwise: those within the scene's bounds are free whose centre is.
    void sample() {
        const openvdb::tree::ValueAccessor<const Mask> free(free_);
        for (std::uint64_t n = 0; n < g_.leaves.box_size(); ++n) {
            const auto leaf = g_.leaves.leaf_at(n);
            std::bitset<512> in_free;
            for (std::int32_t v = 0; v < 512; ++v) {
                in_free[static_cast<std::size_t>(v)] = free.isValueOn(map_voxel(
                    {leaf[0] * 8 + (v >> 6), leaf[1] * 8 + (v >> 3 & 7), leaf[2] * 8 + (v & 7)}));
            }
            set(leaf, in_free);
        }
    }

    // The leaves that lie beyond the scene's bounds become the table's.
    void finish() {
        auto& beyond = g_.leaves.beyond;
        beyond.insert(beyond.end(), beyond_.begin(), beyond_.end());
        std::sort(beyond.begin(), beyond.end());
        beyond.erase(std::unique(beyond.begin(), beyond.end()), beyond.end());
        g_.evidence = {};  // by the table's leaves
    }

  private:
    Mask::ValueOnCIter tiles() const {
        auto tile = free_.cbeginValueOn();
        tile.setMaxDepth(Mask::ValueOnCIter::LEAF_DEPTH - 1);
        return tile;
    }

    openvdb::Coord map_voxel(const LeafTable::Leaf& voxel) const {
        const auto& rows = g_.frame.grid_from_input;
        openvdb::Coord at;
        for (int d = 0; d < 3; ++d) {
            double p = 0;
            for (int a = 0; a < 3; ++a)
                p += rows[static_cast<std::size_t>(a)][static_cast<std::size_t>(d)] *
                     (voxel[static_cast<std::size_t>(a)] + 0.5) * g_.frame.voxel_m;
            const double index = (p - map_.corner_m[static_cast<std::size_t>(d)]) / map_.voxel_m;
            at[d] = static_cast<std::int32_t>(std::floor(std::clamp(index, -2e9, 2e9)));
        }
        return at;
    }

    void set(const LeafTable::Leaf& leaf, const std::bitset<512>& free) {
        if (free.none()) return;
        if (!g_.leaves.in_box(leaf)) beyond_.push_back(leaf);
        constexpr auto empty = static_cast<std::int32_t>(State::empty);
        const auto origin = origin_of(leaf);
        const auto* points = g_.points.probeConstLeaf(origin);
        if (!points && free.all()) {
            g_.state->tree().addTile(1, origin, empty, false);
            return;
        }
        auto* state = g_.state->tree().touchLeaf(origin);
        for (openvdb::Index v = 0; v < 512; ++v) {
            if (free[v] && !(points && points->isValueOn(v))) state->setValueOff(v, empty);
        }
    }

    VoxelScene::Grids& g_;
    const SpaceMap& map_;
    Mask free_;
    std::vector<LeafTable::Leaf> beyond_;
};

}  // namespace

void VoxelScene::set_free(const SpaceMap& map) {
    if (!(map.voxel_m > 0) || !std::isfinite(map.voxel_m)) {
        throw Error(ErrorKind::usage, "a map of voxels of " + std::to_string(map.voxel_m) +
                                          " m: their size must be positive");
    }
    Grids& g = *grids_;
    g.clear_completed();
    Freeing freeing(g, map);
    if (same_voxels(g.frame, map)) {
        freeing.copy();
    } else {
        freeing.sample();
    }
    freeing.finish();
}

}  // namespace topple::vdb
