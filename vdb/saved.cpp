// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cstddef>
#include <set>
#include <span>

#include "core/voxel_spread.h"
#include "topple/error.h"
#include "vdb/grids.h"

namespace topple::vdb {
namespace {

constexpr std::size_t leaf_voxels = 512, leaf_words = leaf_voxels / 64;

Voxel voxel_of(const openvdb::Coord& at) {
    return {at.x(), at.y(), at.z()};
}

// Of leaves by their number, whether sums of their places are no overflow.
bool is_near_leaf(const Voxel& leaf) {
    constexpr std::int32_t farthest = 1 << 27;
    return std::ranges::all_of(leaf, [](auto x) { return x > -farthest && x < farthest; });
}

bool is_leaf(const Voxel& lowest) {
    return std::ranges::all_of(lowest, [](auto x) { return (x & 7) == 0; });
}

// No more leaves than a scene has.
bool is_box(const Voxel& count) {
    std::uint64_t leaves = 1;
    for (const std::int32_t along : count) {
        if (along < 0 || along > 1 << 21) return false;
        leaves *= static_cast<std::uint64_t>(along);
    }
    return leaves <= max_leaves;
}

constexpr auto last_state = static_cast<std::int32_t>(State::completed);

bool is_tile(const SavedVoxels::Tile& tile) {
    const bool known = tile.value >= 0 && tile.value <= last_state;
    return tile.level > 0 && tile.level <= 3 && tile.active == 0 && known;
}

// Whether all that is stored lies together: of trees of voxels each part takes memory.
bool lies_together(const SavedVoxels& s) {
    VoxelSpread spread;
    const auto add = [&](const Voxel& at) { return spread.add(at[0], at[1], at[2]); };
    return std::ranges::all_of(s.leaves, add) && std::ranges::all_of(s.labelled, add) &&
           std::ranges::all_of(s.tiles, [&](const SavedVoxels::Tile& tile) {
               return spread.add(tile.i, tile.j, tile.k);
           });
}

bool fits(const SavedVoxels& s) {
    std::size_t labels = 0;
    for (const std::uint64_t word : s.has_label)
        labels += static_cast<std::size_t>(std::popcount(word));
    const auto lengths =
        s.states.size() == leaf_voxels * s.leaves.size() && s.solid.size() == s.states.size() &&
        s.has_label.size() == leaf_words * s.labelled.size() && s.label.size() == labels;
    const bool right =
        lengths && std::ranges::all_of(s.leaves, is_leaf) &&
        std::ranges::all_of(s.labelled, is_leaf) && std::ranges::all_of(s.tiles, is_tile) &&
        std::ranges::all_of(s.states, [](std::uint8_t state) { return state <= last_state; }) &&
        std::ranges::is_sorted(s.beyond) && std::ranges::all_of(s.beyond, is_near_leaf) &&
        is_near_leaf(s.bounds[0]) && is_box(s.bounds[1]) && lies_together(s);
    if (!right) return false;
    // What is solid has a label, if that is of none.
    const std::set<Voxel> labelled(s.labelled.begin(), s.labelled.end());
    for (std::size_t l = 0; l < s.leaves.size(); ++l) {
        const auto solid = std::span(s.solid).subspan(l * leaf_voxels, leaf_voxels);
        if (std::ranges::any_of(solid, [](auto v) { return v != 0; }) &&
            !labelled.contains(s.leaves[l]))
            return false;
    }
    return true;
}

}  // namespace

SavedVoxels VoxelScene::saved() const {
    const Grids& g = *grids_;
    SavedVoxels out;
    out.frame = g.frame;
    out.bounds = {g.leaves.low, g.leaves.count};
    out.beyond = g.leaves.beyond;
    const auto& state = g.state->tree();
    auto value = state.cbeginValueAll();
    value.setMaxDepth(openvdb::Int32Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; value; ++value) {
        if (!value.isValueOn() && *value == state.background()) continue;
        const openvdb::Coord at = value.getCoord();
        out.tiles.push_back({static_cast<std::int32_t>(value.getLevel()), at.x(), at.y(), at.z(),
                             *value, value.isValueOn()});
    }
    for (auto leaf = state.cbeginLeaf(); leaf; ++leaf) {
        out.leaves.push_back(voxel_of(leaf->origin()));
        for (openvdb::Index n = 0; n < leaf_voxels; ++n) {
            out.states.push_back(static_cast<std::uint8_t>(leaf->getValue(n)));
            out.solid.push_back(leaf->isValueOn(n));
        }
    }
    for (auto leaf = g.primitive->tree().cbeginLeaf(); leaf; ++leaf) {
        out.labelled.push_back(voxel_of(leaf->origin()));
        std::array<std::uint64_t, leaf_words> mask{};
        for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
            mask[voxel.pos() / 64] |= std::uint64_t{1} << voxel.pos() % 64;
            out.label.push_back(*voxel);
        }
        out.has_label.insert(out.has_label.end(), mask.begin(), mask.end());
    }
    return out;
}

VoxelScene::VoxelScene(const SavedVoxels& saved) : VoxelScene(saved.frame) {
    check(saved.frame);
    if (!fits(saved)) throw Error(ErrorKind::input, "saved voxels: they are no scene's");
    Grids& g = *grids_;
    g.leaves = {saved.bounds[0], saved.bounds[1], saved.beyond};
    for (const SavedVoxels::Tile& t : saved.tiles)
        g.state->tree().addTile(static_cast<openvdb::Index>(t.level), {t.i, t.j, t.k}, t.value,
                                t.active != 0);
    for (std::size_t l = 0; l < saved.leaves.size(); ++l) {
        auto* leaf = g.state->tree().touchLeaf(coord(saved.leaves[l]));
        for (openvdb::Index n = 0; n < leaf_voxels; ++n) {
            const std::size_t at = l * leaf_voxels + n;
            leaf->setValueOnly(n, saved.states[at]);
            leaf->setActiveState(n, saved.solid[at] != 0);
        }
    }
    std::size_t next = 0;
    for (std::size_t l = 0; l < saved.labelled.size(); ++l) {
        auto* leaf = g.primitive->tree().touchLeaf(coord(saved.labelled[l]));
        for (openvdb::Index n = 0; n < leaf_voxels; ++n)
            if (saved.has_label[l * leaf_words + n / 64] >> n % 64 & 1)
                leaf->setValueOn(n, saved.label[next++]);
    }
}

}  // namespace topple::vdb
