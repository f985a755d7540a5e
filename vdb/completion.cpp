// SPDX-License-Identifier: MIT
#include "vdb/completion.h"

#include <algorithm>
#include <utility>

#include "core/thread_pool.h"
#include "vdb/grids.h"

namespace topple::vdb {
namespace {

// The cells with the claims among them. Both are sorted.
SolidCells merged(const SolidCells& cells, std::span<const Claim> claims) {
    SolidCells out;
    out.voxel_m = cells.voxel_m;
    const std::size_t most = cells.size() + claims.size();
    for (auto* values : {&out.i, &out.j, &out.k, &out.primitive}) values->reserve(most);
    out.basis.reserve(most);
    auto claim = claims.begin();
    const auto take = [&] {
        if (claim->solid) out.add(claim->at, claim->primitive, claim->basis);
        ++claim;
    };
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const Voxel at = place_of(cells, n);
        while (claim != claims.end() && claim->at < at) take();
        if (claim == claims.end() || claim->at != at)
            out.add(at, cells.primitive[n], cells.basis[n]);
    }
    while (claim != claims.end()) take();
    return out;
}

}  // namespace

void commit(std::span<const Claim> claims, VoxelScene& volume, SolidCells& cells) {
    if (claims.empty()) return;
    VoxelScene::Grids& g = volume.grids();
    auto state = g.state->getAccessor();
    auto primitive = g.primitive->getAccessor();
    std::vector<LeafTable::Leaf> beyond;
    for (const Claim& c : claims) {
        const openvdb::Coord at = coord(c.at);
        const auto leaf = leaf_of(at);
        if (!g.leaves.in_box(leaf) && (beyond.empty() || beyond.back() != leaf))
            beyond.push_back(leaf);
        if (c.solid) {
            const bool seen = c.basis == Basis::surface;
            state.setValueOn(at,
                             static_cast<std::int32_t>(seen ? State::surface : State::completed));
            primitive.setValueOn(at, c.primitive);
        } else {
            state.setValueOff(at, static_cast<std::int32_t>(State::invisible));
            primitive.setValueOff(at, -1);
        }
    }
    if (!beyond.empty()) g.take_in(beyond);
    cells = merged(cells, claims);
}

std::uint64_t fill(device::Device& device, VoxelScene& volume, const FillOptions& options) {
    volume.clear_completed();
    const std::vector<Claim> claims = six_direction_claims(device, volume, options);
    SolidCells cells;
    commit(claims, volume, cells);
    return claims.size();
}

void complete(device::Device& device, const CompletionOptions& options, VoxelScene& volume,
              SolidCells& cells) {
    const auto round = [&](const auto& propose) {
        device.threads().poll();
        commit(propose(VolumeView(volume, cells, options.fill.roles)), volume, cells);
    };
    commit(six_direction_claims(device, volume, options.fill), volume, cells);
    round([&](const VolumeView& view) { return support_claims(view, options.ledges); });
    round([&](const VolumeView& view) { return leg_claims(view); });
    round([&](const VolumeView& view) { return built_in_claims(view); });
    round([&](const VolumeView& view) { return gap_claims(view); });
    round([&](const VolumeView& view) { return detached_claims(view); });
    if (options.map) commit(map_claims(volume, *options.map), volume, cells);
    device.threads().poll();
}

}  // namespace topple::vdb
