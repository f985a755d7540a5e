// SPDX-License-Identifier: MIT
#include "six_fill_sweep.hpp"

#include "errors.h"
#include "oracle/six_fill_oracle.h"
#include "six_fill_vote.hpp"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::test {
namespace {

// A dense random grid of whole leaves; leaf (a, b, c) is leaf number (a * size_b + b) * size_c + c.
struct SweepCase {
    std::array<int, 3> leaves;
    oracle::DenseCells dense;
    std::vector<std::uint32_t> cells;  // leaf by leaf

    SweepCase(std::uint64_t seed, std::array<int, 3> size) : leaves(size) {
        Random random(seed);
        for (int a = 0; a < 3; ++a) dense.size[a] = 8 * leaves[a];
        const std::size_t count = std::size_t{512} * leaves[0] * leaves[1] * leaves[2];
        dense.cell.resize(count);
        cells.resize(count);
        for (int x = 0; x < dense.size[0]; ++x) {
            for (int y = 0; y < dense.size[1]; ++y) {
                for (int z = 0; z < dense.size[2]; ++z) {
                    // Mostly fillable, so that rays run across leaves; labels up to the largest.
                    const std::uint32_t kind = random.below(40);
                    const std::uint32_t cell = kind == 0   ? 0
                                               : kind == 1 ? 2 + random.below(6)
                                               : kind == 2 ? 65535u
                                                           : 1;
                    dense.cell[dense.index({x, y, z})] = cell;
                    cells[address({x, y, z})] = cell;
                }
            }
        }
    }
    std::size_t address(const std::array<int, 3>& v) const {
        const std::size_t leaf =
            (std::size_t(v[0] / 8) * leaves[1] + v[1] / 8) * leaves[2] + v[2] / 8;
        return leaf * 512 + std::size_t(v[0] % 8) * 64 + std::size_t(v[1] % 8) * 8 +
               std::size_t(v[2] % 8);
    }
};

// What lies beyond the run through a voxel, as SixFillSweep::run sets it: seen empty or not.
bool empty_beyond(const std::array<int, 3>& v, int axis, int way) {
    const int a = v[axis == 0 ? 1 : 0] / 8, b = v[axis == 2 ? 1 : 2] / 8;
    return (((a + 2 * b) & 3) >> way & 1) == 0;
}

std::uint32_t expected_hit(const SweepCase& c, const std::array<int, 3>& v, int axis, int way) {
    if (c.dense.cell[c.dense.index(v)] != 1) return 0;
    const oracle::SixHit hit = oracle::walk(c.dense, v, 2 * axis + way, empty_beyond(v, axis, way));
    std::uint32_t cell = static_cast<std::uint32_t>(hit.primitive + 3);
    if (hit.primitive < 0) {
        std::array<int, 3> end = v;
        end[axis] += way ? hit.distance : -hit.distance;
        cell = hit.empty ? 0 : c.dense.inside(end) ? 2 : 1;
    }
    return cell | static_cast<std::uint32_t>(hit.distance) << 16;
}

class SixFillSweep : public EachBackend {
  protected:
    // Backward and forward hits along an axis.
    std::array<std::vector<std::uint32_t>, 2> run(device::Device& on, const SweepCase& c,
                                                  int axis) {
        std::vector<std::uint32_t> first, length, order, ends;
        const int other = axis == 0 ? 1 : 0, last = axis == 2 ? 1 : 2;
        for (int a = 0; a < c.leaves[other]; ++a) {
            for (int b = 0; b < c.leaves[last]; ++b) {
                first.push_back(static_cast<std::uint32_t>(order.size()));
                length.push_back(static_cast<std::uint32_t>(c.leaves[axis]));
                ends.push_back(static_cast<std::uint32_t>(a + 2 * b) & 3u);
                for (int n = 0; n < c.leaves[axis]; ++n) {
                    std::array<int, 3> v{};
                    v[axis] = 8 * n, v[other] = 8 * a, v[last] = 8 * b;
                    order.push_back(static_cast<std::uint32_t>(c.address(v) / 512));
                }
            }
        }
        using device::Buffer;
        Buffer<std::uint32_t> b_first(on, std::span(std::as_const(first)), "first"),
            b_length(on, std::span(std::as_const(length)), "length"),
            b_order(on, std::span(std::as_const(order)), "order"),
            b_ends(on, std::span(std::as_const(ends)), "ends"),
            cells(on, std::span(c.cells), "cells");
        const Guarded<std::uint32_t> back(on, c.cells.size(), "backward"),
            forth(on, c.cells.size(), "forward");
        constexpr std::uint32_t stride[3] = {64, 8, 1}, high[3] = {8, 64, 64}, low[3] = {1, 1, 8};
        run_kernel<kernels::SixFillSweep>(on, first.size() * 64,
                                          {.run_first = b_first,
                                           .run_length = b_length,
                                           .run_leaf = b_order,
                                           .run_ends = b_ends,
                                           .cells = cells,
                                           .backward = back.slice(),
                                           .forward = forth.slice()},
                                          {.run_count = static_cast<std::uint32_t>(first.size()),
                                           .stride = stride[axis],
                                           .stride_high = high[axis],
                                           .stride_low = low[axis]});
        EXPECT_TRUE(back.untouched());
        EXPECT_TRUE(forth.untouched());
        return {back.download(), forth.download()};
    }
};

TEST_P(SixFillSweep, MatchesTheWalk) {
    const std::array<int, 3> shapes[] = {{0, 0, 0}, {1, 1, 1}, {2, 3, 1}, {1, 2, 5}, {5, 7, 3}};
    for (const auto& shape : shapes) {
        const SweepCase c(static_cast<std::uint64_t>(shape[0] * 9 + shape[2] + 1), shape);
        for (int axis = 0; axis < 3; ++axis) {
            const auto hits = run(*device, c, axis);
            std::uint64_t wrong = 0;
            for (int x = 0; x < c.dense.size[0]; ++x) {
                for (int y = 0; y < c.dense.size[1]; ++y) {
                    for (int z = 0; z < c.dense.size[2]; ++z) {
                        for (int way = 0; way < 2; ++way) {
                            const std::uint32_t expected = expected_hit(c, {x, y, z}, axis, way);
                            wrong += hits[way][c.address({x, y, z})] != expected;
                        }
                    }
                }
            }
            EXPECT_EQ(wrong, 0u) << "axis " << axis << ", " << shape[0] << "x" << shape[1] << "x"
                                 << shape[2] << " leaves";
        }
    }
}

TOPPLE_ON_EACH_FORM(SixFillSweep);

struct VoteCase {
    std::vector<std::uint32_t> cells;
    std::array<std::vector<std::uint32_t>, 6> hits;
    VoteCase(std::uint64_t seed, std::uint32_t count) {
        Random random(seed);
        for (std::uint32_t n = 0; n < count; ++n) {
            cells.push_back(random.below(8) == 0 ? random.below(9) : 1);
            // Few labels and distances, so that ties are common; now and then the extremes.
            for (auto& side : hits) {
                const std::uint32_t cell = random.below(30) == 0 ? 65535 : random.below(7);
                const std::uint32_t distance = random.below(30) == 0 ? 65535 : 1 + random.below(3);
                side.push_back(cell | distance << 16);
            }
        }
    }
};

class SixFillVote : public EachBackend {
  protected:
    std::vector<std::uint32_t> run(device::Device& on, const VoteCase& c, std::uint32_t votes,
                                   bool columns) {
        using device::Buffer;
        Buffer<std::uint32_t> cells(on, std::span(c.cells), "cells");
        std::vector<Buffer<std::uint32_t>> hits;
        for (const auto& side : c.hits) hits.emplace_back(on, std::span(side), "hits");
        const Guarded<std::uint32_t> filled(on, c.cells.size(), "filled");
        run_kernel<kernels::SixFillVote>(on, c.cells.size(),
                                         {.cells = cells,
                                          .hit_0 = hits[0],
                                          .hit_1 = hits[1],
                                          .hit_2 = hits[2],
                                          .hit_3 = hits[3],
                                          .hit_4 = hits[4],
                                          .hit_5 = hits[5],
                                          .filled = filled.slice()},
                                         {.count = static_cast<std::uint32_t>(c.cells.size()),
                                          .votes = votes,
                                          .columns = columns ? 1u : 0u});
        EXPECT_TRUE(filled.untouched());
        return filled.download();
    }
};

TEST_P(SixFillVote, MatchesTheCount) {
    for (const std::uint32_t count : {0u, 1u, 63u, 64u, 65u, 100003u}) {
        for (const std::uint32_t votes : {1u, 2u, 3u, 6u}) {
            const VoteCase c(count + votes, count);
            const bool columns = votes == 2 || votes == 6;
            const auto filled = run(*device, c, votes, columns);
            std::uint64_t wrong = 0;
            for (std::uint32_t n = 0; n < count; ++n) {
                std::array<oracle::SixHit, 6> hits;
                for (std::size_t side = 0; side < 6; ++side) {
                    const std::uint32_t hit = c.hits[side][n];
                    const auto cell = static_cast<std::int32_t>(hit & 0xffff);
                    hits[side] = {std::max(cell - 3, -1), static_cast<int>(hit >> 16), cell == 0};
                }
                std::int32_t expected = -1;
                if (c.cells[n] == 1) {
                    expected = oracle::vote(hits, static_cast<int>(votes));
                    if (columns && expected < 0) expected = oracle::column(hits);
                }
                if (filled[n] != static_cast<std::uint32_t>(expected + 1) && ++wrong < 5) {
                    ADD_FAILURE() << "voxel " << n << ": " << filled[n] << ", expected "
                                  << expected + 1;
                }
            }
            EXPECT_EQ(wrong, 0u) << count << " voxels, " << votes << " votes";
        }
    }
}

TOPPLE_ON_EACH_FORM(SixFillVote);

}  // namespace
}  // namespace topple::test
