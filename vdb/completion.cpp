// SPDX-License-Identifier: MIT
#include "vdb/completion.h"

#include <algorithm>
#include <utility>

#include "core/thread_pool.h"
#include "vdb/fill_chance.h"
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

// Unlikely cells where two voxels each way are that or not solid: crevices are no hollows.
std::vector<Voxel> wide_unlikely(const VolumeView& view) {
    const SolidCells& cells = view.cells();
    std::vector<Voxel> unlikely, out;
    for (std::size_t n = 0; n < cells.size(); ++n)
        if (cells.basis[n] == Basis::unlikely) unlikely.push_back(place_of(cells, n));
    const auto is_open = [&](const Voxel& at) {
        return !view.solid(at) || std::ranges::binary_search(unlikely, at);
    };
    // The cube of two voxels each way from one of its corners on.
    const auto open_cube = [&](const Voxel& at, int ways) {
        for (int corner = 1; corner < 8; ++corner) {
            Voxel beside = at;
            for (std::size_t a = 0; a < 3; ++a)
                if (corner >> a & 1) beside[a] += ways >> a & 1 ? 1 : -1;
            if (!is_open(beside)) return false;
        }
        return true;
    };
    for (const Voxel& at : unlikely) {
        bool wide = false;
        for (int ways = 0; ways < 8 && !wide; ++ways) wide = open_cube(at, ways);
        if (wide) out.push_back(at);
    }
    return out;
}

// Of what the rays end at. Nothing that another rule has completed goes.
std::vector<Claim> likely_claims(const VolumeView& view, std::span<const RayEnds> rays) {
    std::vector<Claim> out;
    for (const Voxel& at : wide_unlikely(view)) out.push_back({at, -1, Basis::unlikely, false});
    for (const RayEnds& each : rays)
        if (is_surely(each.ends) && view.unseen_run(each.at, 0, 1, 1) == 1)
            out.push_back({each.at, each.primitive, basis_of(each.ends)});
    std::ranges::sort(out, {}, &Claim::at);
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
    const std::vector<Claim> claims = claims_of(six_direction_rays(
        device, volume, options, [](const RayEnds& each) { return each.taken; }));
    SolidCells cells;
    commit(claims, volume, cells);
    return claims.size();
}

std::vector<Claim> complete(device::Device& device, const CompletionOptions& options,
                            VoxelScene& volume, SolidCells& cells) {
    const auto round = [&](const auto& propose) {
        device.threads().poll();
        commit(propose(VolumeView(volume, cells, options.fill.roles)), volume, cells);
    };
    const std::vector<RayEnds> rays =
        six_direction_rays(device, volume, options.fill,
                           [](const RayEnds& each) { return each.taken || is_surely(each.ends); });
    commit(claims_of(rays), volume, cells);
    round([&](const VolumeView& view) { return support_claims(view, options.ledges); });
    round([&](const VolumeView& view) { return leg_claims(view); });
    round([&](const VolumeView& view) { return built_in_claims(view); });
    round([&](const VolumeView& view) { return gap_claims(view); });
    round([&](const VolumeView& view) { return detached_claims(view); });
    if (options.map) commit(map_claims(volume, *options.map), volume, cells);
    device.threads().poll();
    return likely_claims(VolumeView(volume, cells, options.fill.roles), rays);
}

}  // namespace topple::vdb
