// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bitset>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/short_number.h"
#include "topple/error.h"
#include "vdb/completion.h"
#include "vdb/grids.h"

// Free and solid space that comes as a map instead of frames.
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

// The voxels of a map's boxes, by the grid's leaves.
class Boxes {
  public:
    Boxes(const VoxelScene::Grids& grids, const SpaceMap& map,
          const std::vector<SpaceMap::Box>& boxes)
        : g_(grids), map_(map) {
        for (const SpaceMap::Box& box : boxes) {
            within_.fill(openvdb::CoordBBox(openvdb::Coord(box.low[0], box.low[1], box.low[2]),
                                            openvdb::Coord(box.high[0], box.high[1], box.high[2])),
                         true, true);
        }
    }

    ~Boxes() { clear_tree(within_); }
    Boxes(const Boxes&) = delete;
    Boxes& operator=(const Boxes&) = delete;

    // Calls set(leaf, voxels) for each leaf with voxels whose centre lies within.
    template <class Set>
    void each_leaf(const Set& set) const {
        if (same_voxels(g_.frame, map_)) {
            copy(set);
        } else {
            sample(set);
        }
    }

  private:
    // The map's voxels are the grid's: all of them count, within the scene's bounds and beyond.
    template <class Set>
    void copy(const Set& set) const {
        std::uint64_t blocks = within_.leafCount();
        for (auto tile = tiles(); tile; ++tile) {
            const auto box = tile.getBoundingBox();
            blocks += box.volume() / 512;
        }
        if (blocks > most_blocks) {
            throw Error(ErrorKind::input, "the map's free or occupied space holds " +
                                              std::to_string(blocks) +
                                              " blocks of 8x8x8 voxels, more than the limit of " +
                                              std::to_string(most_blocks) + "; crop the map");
        }
        for (auto leaf = within_.cbeginLeaf(); leaf; ++leaf) {
            std::bitset<512> voxels;
            for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) voxels.set(voxel.pos());
            if (voxels.any()) set(leaf_of(leaf->origin()), voxels);
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

    // The grid's voxels lie otherwise: those within the scene's bounds count whose centre does.
    template <class Set>
    void sample(const Set& set) const {
        const openvdb::tree::ValueAccessor<const Mask> within(within_);
        for (std::uint64_t n = 0; n < g_.leaves.box_size(); ++n) {
            const auto leaf = g_.leaves.leaf_at(n);
            std::bitset<512> voxels;
            for (std::int32_t v = 0; v < 512; ++v) {
                voxels[v] = within.isValueOn(map_voxel(
                    {leaf[0] * 8 + (v >> 6), leaf[1] * 8 + (v >> 3 & 7), leaf[2] * 8 + (v & 7)}));
            }
            if (voxels.any()) set(leaf, voxels);
        }
    }

    Mask::ValueOnCIter tiles() const {
        auto tile = within_.cbeginValueOn();
        tile.setMaxDepth(Mask::ValueOnCIter::LEAF_DEPTH - 1);
        return tile;
    }

    openvdb::Coord map_voxel(const LeafTable::Leaf& voxel) const {
        const auto& rows = g_.frame.grid_from_input;
        openvdb::Coord at;
        for (int d = 0; d < 3; ++d) {
            double p = 0;
            for (int a = 0; a < 3; ++a) p += rows[a][d] * (voxel[a] + 0.5) * g_.frame.voxel_m;
            const double index = (p - map_.corner_m[d]) / map_.voxel_m;
            at[d] = static_cast<std::int32_t>(std::floor(std::clamp(index, -2e9, 2e9)));
        }
        return at;
    }

    const VoxelScene::Grids& g_;
    const SpaceMap& map_;
    Mask within_;
};

void set_leaf_free(VoxelScene::Grids& g, const LeafTable::Leaf& leaf,
                   const std::bitset<512>& free) {
    constexpr auto empty = static_cast<std::int32_t>(State::empty);
    const auto origin = origin_of(leaf);
    const auto* points = g.points.probeConstLeaf(origin);
    if (!points && free.all()) {
        g.state->tree().addTile(1, origin, empty, false);
        return;
    }
    auto* state = g.state->tree().touchLeaf(origin);
    for (openvdb::Index v = 0; v < 512; ++v) {
        if (free[v] && !(points && points->isValueOn(v))) state->setValueOff(v, empty);
    }
}

void check(const SpaceMap& map) {
    if (map.voxel_m > 0 && std::isfinite(map.voxel_m)) return;
    throw Error(ErrorKind::usage, "a map of voxels of " + short_number(map.voxel_m) +
                                      " m: their size must be positive");
}

}  // namespace

void VoxelScene::set_free(const SpaceMap& map) {
    check(map);
    clear_completed();
    Grids& g = *grids_;
    std::vector<LeafTable::Leaf> leaves;
    Boxes(g, map, map.free).each_leaf([&](const LeafTable::Leaf& leaf, const auto& voxels) {
        leaves.push_back(leaf);
        set_leaf_free(g, leaf, voxels);
    });
    g.take_in(leaves);
}

std::vector<Claim> map_claims(const VoxelScene& volume, const SpaceMap& map) {
    check(map);
    const VoxelScene::Grids& g = volume.grids();
    std::map<LeafTable::Leaf, std::bitset<512>> solid;
    Boxes(g, map, map.solid).each_leaf([&](const LeafTable::Leaf& leaf, const auto& voxels) {
        solid[leaf] |= voxels;
    });
    std::vector<LeafTable::Leaf> leaves;
    std::vector<std::bitset<512>> within;
    for (const auto& [leaf, voxels] : solid) {
        leaves.push_back(leaf);
        within.push_back(voxels);
    }
    const auto state = g.state->getConstAccessor();
    const auto primitive = g.primitive->getConstAccessor();
    std::vector<Claim> claims;
    in_voxel_order(leaves, [&](std::size_t leaf, std::size_t offset, const Voxel& at) {
        constexpr auto seen = static_cast<std::int32_t>(State::surface);
        if (!within[leaf][offset] || state.getValue(coord(at)) == seen) return;
        claims.push_back({at, primitive.getValue(coord(at)), Basis::surface});
    });
    return claims;
}

}  // namespace topple::vdb
