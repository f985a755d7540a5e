// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>
#include <string>

#include "topple/error.h"
#include "vdb/grids.h"

// VoxelScene's contents, flattened.
namespace topple::vdb {
namespace {

std::vector<LeafTable::Leaf> solid_leaves(const openvdb::Int32Grid& state) {
    std::vector<LeafTable::Leaf> leaves;
    for (auto leaf = state.tree().cbeginLeaf(); leaf; ++leaf) {
        if (!leaf->isEmpty()) leaves.push_back(leaf_of(leaf->origin()));
    }
    std::sort(leaves.begin(), leaves.end());
    return leaves;
}

}  // namespace

void VoxelScene::put_leaf(const std::array<std::int32_t, 3>& lowest,
                          std::span<const std::uint8_t> states) {
    if (states.size() != 512)
        throw Error(ErrorKind::usage, "put_leaf: " + std::to_string(states.size()) + " states");
    const openvdb::Coord origin(lowest[0], lowest[1], lowest[2]);
    auto& tree = grids_->state->tree();
    grids_->leaves.beyond.push_back(leaf_of(origin));  // there is no box
    if (std::ranges::all_of(states, [&](std::uint8_t s) { return s == states[0]; }) &&
        states[0] == static_cast<std::uint8_t>(State::empty)) {
        tree.addTile(1, origin, states[0], false);
        return;
    }
    auto* leaf = tree.touchLeaf(origin);
    bool solid = false;
    for (openvdb::Index v = 0; v < 512; ++v) {
        const auto state = static_cast<State>(states[v]);
        if (state == State::surface || state == State::completed) {
            leaf->setValueOn(v, states[v]);
            solid = true;
        } else {
            leaf->setValueOff(v, states[v]);
        }
    }
    if (solid) grids_->primitive->tree().touchLeaf(origin);
}

void VoxelScene::put_label(std::int32_t i, std::int32_t j, std::int32_t k, std::int32_t primitive) {
    grids_->primitive->tree().setValueOn({i, j, k}, primitive);
}

Tiles VoxelScene::tiles(bool all) const {
    std::vector<LeafTable::Leaf> leaves;
    if (all) {
        leaves.resize(grids_->leaves.size());
        for (std::uint64_t n = 0; n < leaves.size(); ++n) leaves[n] = grids_->leaves.leaf_at(n);
        std::sort(leaves.begin(), leaves.end());
    } else {
        leaves = solid_leaves(*grids_->state);
    }
    Tiles tiles;
    for (const auto& leaf : leaves) {
        tiles.x.push_back(leaf[0] * 8);
        tiles.y.push_back(leaf[1] * 8);
        tiles.z.push_back(leaf[2] * 8);
    }
    return tiles;
}

std::vector<std::uint8_t> VoxelScene::states(const Tiles& tiles) const {
    std::vector<std::uint8_t> out(tiles.size() * 512);
    const auto accessor = grids_->state->getConstAccessor();
    for (std::size_t n = 0; n < tiles.size(); ++n) {
        const openvdb::Coord origin(tiles.x[n], tiles.y[n], tiles.z[n]);
        auto* to = out.data() + n * 512;
        if (const auto* leaf = accessor.probeConstLeaf(origin)) {
            const std::int32_t* from = leaf->buffer().data();
            for (int v = 0; v < 512; ++v) to[v] = static_cast<std::uint8_t>(from[v]);
        } else {
            std::fill(to, to + 512, static_cast<std::uint8_t>(accessor.getValue(origin)));
        }
    }
    return out;
}

std::vector<std::int32_t> VoxelScene::primitives(const Tiles& tiles) const {
    std::vector<std::int32_t> out(tiles.size() * 512, -1);
    const auto state = grids_->state->getConstAccessor();
    const auto primitive = grids_->primitive->getConstAccessor();
    for (std::size_t n = 0; n < tiles.size(); ++n) {
        const openvdb::Coord origin(tiles.x[n], tiles.y[n], tiles.z[n]);
        const auto* solid = state.probeConstLeaf(origin);
        const auto* label = primitive.probeConstLeaf(origin);
        if (!solid || !label) continue;
        for (auto voxel = solid->cbeginValueOn(); voxel; ++voxel) {
            out[n * 512 + voxel.pos()] = label->getValue(voxel.pos());
        }
    }
    return out;
}

State VoxelScene::state_at(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return static_cast<State>(grids_->state->tree().getValue({i, j, k}));
}

SolidCells VoxelScene::solid_cells() const {
    const std::vector<LeafTable::Leaf> leaves = solid_leaves(*grids_->state);
    std::vector<std::pair<const StateLeaf*, const StateLeaf*>> grids;  // state, primitive
    for (const auto& leaf : leaves) {
        const auto origin = origin_of(leaf);
        grids.emplace_back(grids_->state->tree().probeConstLeaf(origin),
                           grids_->primitive->tree().probeConstLeaf(origin));
    }
    SolidCells cells;
    cells.voxel_m = grids_->frame.voxel_m;
    const auto count = grids_->state->activeVoxelCount();
    for (auto* values : {&cells.i, &cells.j, &cells.k, &cells.primitive}) values->reserve(count);
    cells.basis.reserve(count);
    in_voxel_order(leaves, [&](std::size_t leaf, std::size_t at, const Voxel& voxel) {
        const auto& [state, primitive] = grids[leaf];
        const auto offset = static_cast<openvdb::Index>(at);
        if (!state->isValueOn(offset)) return;
        const bool seen = state->getValue(offset) == static_cast<std::int32_t>(State::surface);
        cells.add(voxel, primitive->getValue(offset), seen ? Basis::surface : Basis::half_enclosed);
    });
    return cells;
}

SolidVoxels solid_voxels(const VoxelFrame& frame, const SolidCells& cells,
                         std::span<const std::int32_t> object_of_primitive) {
    SolidVoxels out;
    const std::size_t count = cells.size();
    for (auto* values : {&out.x, &out.y, &out.z}) values->resize(count);
    out.object.resize(count);
    out.state.resize(count);
    for (std::size_t n = 0; n < count; ++n) {
        const double v = frame.voxel_m;
        const Vec3 p = frame.input_of(
            {(cells.i[n] + 0.5) * v, (cells.j[n] + 0.5) * v, (cells.k[n] + 0.5) * v});
        out.x[n] = static_cast<float>(p[0]);
        out.y[n] = static_cast<float>(p[1]);
        out.z[n] = static_cast<float>(p[2]);
        const auto primitive = static_cast<std::size_t>(cells.primitive[n]);
        const bool known = cells.primitive[n] >= 0 && primitive < object_of_primitive.size();
        out.object[n] = known ? object_of_primitive[primitive] : -1;
        out.state[n] = cells.basis[n] != Basis::surface;
    }
    out.primitive = cells.primitive;
    return out;
}

}  // namespace topple::vdb
