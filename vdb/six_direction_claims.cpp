// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "core/short_number.h"
#include "core/thread_pool.h"
#include "six_fill_sweep.hpp"
#include "six_fill_vote.hpp"
#include "topple/error.h"
#include "topple/kernels/buffer.h"
#include "topple/kernels/queue.h"
#include "vdb/completion.h"
#include "vdb/fill_chance.h"
#include "vdb/fill_leaves.h"
#include "vdb/grids.h"

// Six-direction filling: which leaves to sweep, their runs along each axis, and the vote.
namespace topple::vdb {
namespace {

constexpr std::int32_t max_primitives = 65532;  // cells travel as 16 bits

// Two of what six_fill_sweep calls cells.
constexpr std::uint32_t ground = 3, first_primitive = 4;

// All of those.
std::vector<std::uint32_t> cells_of(const VoxelScene::Grids& g,
                                    const std::vector<LeafTable::Leaf>& leaves,
                                    const std::vector<bool>& fills, std::int32_t lowest,
                                    ThreadPool& threads) {
    constexpr std::uint64_t leaves_at_once = 64;
    std::vector<std::uint32_t> cells(leaves.size() * 512, 1);
    threads.each(leaves.size(), leaves_at_once, [&](std::size_t n) {
        for (std::size_t v = 0; v < 512; ++v) {
            if (leaves[n][2] * 8 + static_cast<std::int32_t>(v & 7) < lowest)
                cells[n * 512 + v] = ground;
        }
        const auto* state = g.state->tree().probeConstLeaf(origin_of(leaves[n]));
        if (!state) return;
        const auto* label = g.primitive->tree().probeConstLeaf(origin_of(leaves[n]));
        for (openvdb::Index v = 0; v < 512; ++v) {
            std::uint32_t& cell = cells[n * 512 + v];
            if (state->getValue(v) == static_cast<std::int32_t>(State::invisible)) continue;
            cell = 0;
            if (state->isValueOn(v)) {
                const std::int32_t p = label->getValue(v);
                const bool votes = p >= 0 && fills[p];
                cell = votes ? static_cast<std::uint32_t>(p) + first_primitive : 2;
            }
        }
        const std::int64_t index = g.leaves.index_of(leaves[n]);
        if (index < 0) return;
        const std::uint64_t first = static_cast<std::uint64_t>(index) << 9;
        for (auto at = std::ranges::lower_bound(g.sided, first);
             at != g.sided.end() && *at >> 9 == first >> 9; ++at) {
            std::uint32_t& cell = cells[n * 512 + (*at & 511)];
            if (cell >= first_primitive)
                cell |= static_cast<std::uint32_t>(g.seen_side[at - g.sided.begin()]) << 16;
        }
    });
    return cells;
}

// Words for each voxel that is swept: its cell and, of its leaf, what rays bring there on the
// device; its cell, then what becomes of it and why, on the host.
constexpr std::uint64_t sweep_words = 3;

void check_memory(const device::Device& device, const VoxelScene::Grids& g, std::uint64_t leaves) {
    const std::uint64_t bytes = leaves * 512 * sizeof(std::uint32_t) * sweep_words;
    const std::uint64_t memory = device.info().limits.memory_bytes;
    if (bytes <= memory) return;
    const auto gigabytes = [](std::uint64_t n) { return std::to_string(n >> 30) + " GiB"; };
    const double scale = std::cbrt(static_cast<double>(bytes) / static_cast<double>(memory));
    throw Error(ErrorKind::input,
                "filling: " + std::to_string(leaves) +
                    " blocks of 8x8x8 voxels lie between the scene's surfaces, unseen; they take " +
                    gigabytes(bytes) + ", more than the " + gigabytes(memory) + " of " +
                    device.info().name + "; use voxel_m (--voxel) = " +
                    short_number(std::ceil(g.frame.voxel_m * scale * 1100) / 1000) + " or larger");
}

// Runs of leaves that follow one another along an axis, and what lies beyond them.
struct Runs {
    std::vector<std::uint32_t> first, length, leaf, ends;
};
Runs runs_along(const VoxelScene::Grids& g, const std::vector<LeafTable::Leaf>& leaves, int axis) {
    const int other = axis == 0 ? 1 : 0, last = axis == 2 ? 1 : 2;
    Runs runs;
    runs.leaf.resize(leaves.size());
    std::iota(runs.leaf.begin(), runs.leaf.end(), 0u);
    std::sort(runs.leaf.begin(), runs.leaf.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto key = [&](std::uint32_t n) {
            return std::array{leaves[n][other], leaves[n][last], leaves[n][axis]};
        };
        return key(a) < key(b);
    });
    for (std::uint32_t n = 0; n < runs.leaf.size(); ++n) {
        if (n > 0) {
            auto expected = leaves[runs.leaf[n - 1]];
            ++expected[axis];
            if (leaves[runs.leaf[n]] == expected) {
                ++runs.length.back();
                continue;
            }
        }
        runs.first.push_back(n);
        runs.length.push_back(1);
    }
    const auto state = g.state->getConstAccessor();
    for (std::size_t r = 0; r < runs.first.size(); ++r) {
        auto before = leaves[runs.leaf[runs.first[r]]];
        auto after = leaves[runs.leaf[runs.first[r] + runs.length[r] - 1]];
        --before[axis];
        ++after[axis];
        runs.ends.push_back((uniformly_empty(state, before) ? 0u : 1u) |
                            (uniformly_empty(state, after) ? 0u : 2u));
    }
    return runs;
}

// What six_fill_vote finds, by voxel of the leaves.
std::vector<std::uint32_t> sweep_and_vote(device::Device& device, const VoxelScene::Grids& g,
                                          const std::vector<LeafTable::Leaf>& leaves,
                                          std::vector<std::uint32_t> cells,
                                          const FillOptions& options) {
    constexpr std::size_t entries_of_leaf = 6 * 64;
    const std::size_t count = cells.size();
    const device::Buffer<std::uint32_t> cell_words(device, std::span<const std::uint32_t>(cells),
                                                   "fill cells");
    cells = {};
    const device::Buffer<std::uint32_t> entries(device, leaves.size() * entries_of_leaf,
                                                "fill entries");
    std::vector<device::Buffer<std::uint32_t>> keep;
    keep.reserve(12);
    device::Queue queue(device);
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const Runs runs = runs_along(g, leaves, static_cast<int>(axis));
        const auto buffer =
            [&](const std::vector<std::uint32_t>& data) -> device::Buffer<std::uint32_t>& {
            return keep.emplace_back(device, std::span<const std::uint32_t>(data), "fill runs");
        };
        const auto& first = buffer(runs.first);
        const auto& length = buffer(runs.length);
        const auto& order = buffer(runs.leaf);
        const auto& ends = buffer(runs.ends);
        queue.add<kernels::SixFillSweep>(
            runs.first.size() * 64,
            {.run_first = first,
             .run_length = length,
             .run_leaf = order,
             .run_ends = ends,
             .cells = cell_words,
             .entries = entries},
            {.run_count = static_cast<std::uint32_t>(runs.first.size()), .direction = 2 * axis});
    }
    // In portions, for memory.
    constexpr std::size_t leaves_at_once = std::size_t{1} << 14;
    const std::size_t most = std::min(leaves.size(), leaves_at_once);
    const device::Buffer<std::uint32_t> filled(device, most * 512, "filled voxels");
    std::vector<std::uint32_t> out(count);
    for (std::size_t leaf = 0; leaf < leaves.size(); leaf += most) {
        const std::size_t some = std::min(most, leaves.size() - leaf), first = leaf * 512;
        queue.add<kernels::SixFillVote>(
            some * 512,
            {.cells = cell_words.slice(first, some * 512),
             .entries = entries.slice(leaf * entries_of_leaf, some * entries_of_leaf),
             .filled = filled},
            {.count = static_cast<std::uint32_t>(some * 512),
             .votes = options.votes,
             .columns = options.columns ? 1u : 0u});
        queue.run();
        filled.download(std::span(out).subspan(first, some * 512));
    }
    return out;
}

}  // namespace

std::vector<RayEnds> six_direction_rays(device::Device& device, const VoxelScene& volume,
                                        const FillOptions& options,
                                        const std::function<bool(const RayEnds&)>& keep) {
    if (options.votes < 1 || options.votes > 6) {
        throw Error(ErrorKind::usage, "filling: " + std::to_string(options.votes) +
                                          " votes; there are six directions");
    }
    const VoxelScene::Grids& g = volume.grids();
    std::int32_t highest = -1;
    for (auto leaf = g.primitive->tree().cbeginLeaf(); leaf; ++leaf) {
        for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel)
            highest = std::max(highest, *voxel);
    }
    if (highest >= max_primitives) {
        throw Error(ErrorKind::input, "filling: primitive " + std::to_string(highest) +
                                          " is beyond the limit of " +
                                          std::to_string(max_primitives) +
                                          " primitives; use a larger voxel_m (--voxel)");
    }
    std::vector<bool> fills;
    for (std::int32_t p = 0; p <= highest; ++p)
        fills.push_back(!is_sheet(role_of(options.roles, p)));

    const auto leaves = leaves_to_fill(g, fills, options.votes, options.lowest);
    if (leaves.empty()) return {};
    check_memory(device, g, leaves.size());
    const std::vector<std::uint32_t> words = sweep_and_vote(
        device, g, leaves, cells_of(g, leaves, fills, options.lowest, device.threads()), options);
    std::vector<RayEnds> out;
    in_voxel_order(leaves, [&](std::size_t leaf, std::size_t offset, const Voxel& at) {
        const std::uint32_t word = words[leaf * 512 + offset];
        if (word == 0) return;
        const bool agree = word >> 24 != 0;
        const auto ends =
            static_cast<std::uint8_t>((word >> 16 & 127) + (agree ? all_ends / 2 : 0));
        const RayEnds each{at, static_cast<std::int32_t>(word & 65535) - 1, ends,
                           (word >> 23 & 1) != 0};
        if (keep(each)) out.push_back(each);
    });
    return out;
}

std::vector<Claim> claims_of(std::span<const RayEnds> rays) {
    std::vector<Claim> out;
    for (const RayEnds& each : rays)
        if (each.taken) out.push_back({each.at, each.primitive, basis_of(each.ends)});
    return out;
}

}  // namespace topple::vdb
