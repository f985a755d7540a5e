// SPDX-License-Identifier: MIT
#include <bit>
#include <cstddef>
#include <set>

#include "topple/error.h"
#include "vdb/grids.h"

namespace topple::vdb {
namespace {

constexpr std::size_t leaf_voxels = 512, leaf_words = leaf_voxels / 64;

Voxel voxel_of(const openvdb::Coord& at) {
    return {at.x(), at.y(), at.z()};
}

bool is_leaf(const Voxel& lowest) {
    for (const std::int32_t x : lowest)
        if ((x & 7) != 0) return false;
    return true;
}

bool fits(const SavedVoxels& s) {
    std::size_t labels = 0;
    for (const std::uint64_t word : s.has_label)
        labels += static_cast<std::size_t>(std::popcount(word));
    bool right =
        s.states.size() == leaf_voxels * s.leaves.size() && s.solid.size() == s.states.size() &&
        s.has_label.size() == leaf_words * s.labelled.size() && s.label.size() == labels &&
        std::ranges::all_of(s.leaves, is_leaf) && std::ranges::all_of(s.labelled, is_leaf) &&
        std::ranges::is_sorted(s.beyond) && s.frame.voxel_m > 0;
    for (const std::int32_t count : s.bounds[1]) right = right && count >= 0 && count < 1 << 20;
    for (const SavedVoxels::Tile& tile : s.tiles)
        right =
            right && tile.level > 0 && tile.level <= 3 && (tile.active == 0 || tile.active == 1);
    // What is solid has a label, if that is of none.
    const std::set<Voxel> labelled(s.labelled.begin(), s.labelled.end());
    for (std::size_t l = 0; right && l < s.leaves.size(); ++l) {
        const auto first = s.solid.begin() + static_cast<std::ptrdiff_t>(l * leaf_voxels);
        const bool any =
            std::any_of(first, first + leaf_voxels, [](auto solid) { return solid != 0; });
        right = !any || labelled.contains(s.leaves[l]);
    }
    return right;
}

}  // namespace

SavedVoxels VoxelScene::saved() const {
    const Grids& g = *grids_;
    SavedVoxels out;
    out.frame = g.frame;
    out.bounds = {g.leaves.low, g.leaves.count, g.lowest, g.highest};
    out.unplaced = g.unplaced;
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
    if (!fits(saved)) throw Error(ErrorKind::input, "saved voxels: they are no scene's");
    Grids& g = *grids_;
    g.leaves = {saved.bounds[0], saved.bounds[1], saved.beyond};
    g.lowest = saved.bounds[2];
    g.highest = saved.bounds[3];
    g.unplaced = saved.unplaced;
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
