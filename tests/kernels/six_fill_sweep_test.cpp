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
                    const std::uint32_t sides = random.below(2) * random.below(64) << 16;
                    const std::uint32_t cell = kind == 0   ? 0
                                               : kind == 1 ? 2 + random.below(2)
                                               : kind == 2 ? 65535u | sides
                                               : kind == 3 ? (4 + random.below(6)) | sides
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

// The lowest voxel of a line of a leaf, and the axis' other end for the way forward.
std::array<int, 3> entered(const std::array<int, 3>& lowest, int line, int axis, int way) {
    std::array<int, 3> v = lowest;
    v[axis == 0 ? 1 : 0] += line / 8;
    v[axis == 2 ? 1 : 2] += line % 8;
    v[axis] += way ? 7 : 0;
    return v;
}

std::uint32_t expected_entry(const SweepCase& c, const std::array<int, 3>& v, int axis, int way) {
    const oracle::SixHit hit = oracle::walk(c.dense, v, 2 * axis + way, empty_beyond(v, axis, way));
    constexpr std::array<std::uint32_t, 4> cell_of{1, 0, 2, 3};  // by where it ends
    const std::uint32_t cell = hit.primitive >= 0 ? static_cast<std::uint32_t>(hit.primitive + 4)
                                                  : cell_of[static_cast<std::size_t>(hit.end)];
    return cell | std::uint32_t{hit.end == oracle::End::front} << 16 |
           static_cast<std::uint32_t>(hit.distance - 1) << 17;
}

class SixFillSweep : public EachBackend {
  protected:
    std::vector<std::uint32_t> run(device::Device& on, const SweepCase& c) {
        using device::Buffer;
        const Buffer<std::uint32_t> cells(on, std::span(c.cells), "cells");
        const Guarded<std::uint32_t> entries(on, c.cells.size() / 512 * 384, "entries");
        for (int axis = 0; axis < 3; ++axis) {
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
            const Buffer<std::uint32_t> b_first(on, std::span(std::as_const(first)), "first"),
                b_length(on, std::span(std::as_const(length)), "length"),
                b_order(on, std::span(std::as_const(order)), "order"),
                b_ends(on, std::span(std::as_const(ends)), "ends");
            run_kernel<kernels::SixFillSweep>(
                on, first.size() * 64,
                {.run_first = b_first,
                 .run_length = b_length,
                 .run_leaf = b_order,
                 .run_ends = b_ends,
                 .cells = cells,
                 .entries = entries.slice()},
                {.run_count = static_cast<std::uint32_t>(first.size()),
                 .direction = static_cast<std::uint32_t>(2 * axis)});
        }
        EXPECT_TRUE(entries.untouched());
        return entries.download();
    }
};

TEST_P(SixFillSweep, MatchesTheWalk) {
    const std::array<int, 3> shapes[] = {{0, 0, 0}, {1, 1, 1}, {2, 3, 1}, {1, 2, 5}, {5, 7, 3}};
    for (const auto& shape : shapes) {
        const SweepCase c(static_cast<std::uint64_t>(shape[0] * 9 + shape[2] + 1), shape);
        const std::vector<std::uint32_t> entries = run(*device, c);
        std::uint64_t wrong = 0;
        for (int x = 0; x < c.dense.size[0]; x += 8) {
            for (int y = 0; y < c.dense.size[1]; y += 8) {
                for (int z = 0; z < c.dense.size[2]; z += 8) {
                    const std::size_t leaf = c.address({x, y, z}) / 512;
                    for (int side = 0; side < 6; ++side) {
                        for (int line = 0; line < 64; ++line) {
                            const auto v = entered({x, y, z}, line, side / 2, side % 2);
                            wrong +=
                                entries[leaf * 384 + static_cast<std::size_t>(64 * side + line)] !=
                                expected_entry(c, v, side / 2, side % 2);
                        }
                    }
                }
            }
        }
        EXPECT_EQ(wrong, 0u) << shape[0] << "x" << shape[1] << "x" << shape[2] << " leaves";
    }
}

TOPPLE_ON_EACH_FORM(SixFillSweep);

// Leaves that have nothing to do with one another.
struct VoteCase {
    std::vector<std::uint32_t> cells, entries;
    VoteCase(std::uint64_t seed, std::uint32_t leaves) {
        Random random(seed);
        const auto label = [&] { return random.below(30) == 0 ? 65535 : random.below(9); };
        for (std::uint32_t n = 0; n < 512 * leaves; ++n)
            cells.push_back(random.below(8) == 0 ? label() : 1);
        for (std::uint32_t& cell : cells)
            if (cell > 3) cell |= random.below(2) * random.below(64) << 16;
        // Few labels and distances, so that ties are common; now and then the extremes.
        for (std::uint32_t n = 0; n < 384 * leaves; ++n) {
            const std::uint32_t distance =
                random.below(30) == 0 ? 32767 - random.below(9) : random.below(3);
            const std::uint32_t cell = label();
            const std::uint32_t front = cell > 3 ? random.below(2) : 0;
            entries.push_back(cell | front << 16 | distance << 17);
        }
    }
    // By walking through the leaf, and on from where the ray leaves it.
    oracle::SixHit hit(std::size_t leaf, std::array<int, 3> v, int side) const {
        const int axis = side / 2;
        for (std::uint32_t distance = 1;; ++distance) {
            v[axis] += side % 2 ? 1 : -1;
            std::uint32_t cell = 1;
            if (v[axis] < 0 || v[axis] > 7) {
                const int line = 8 * v[axis == 0 ? 1 : 0] + v[axis == 2 ? 1 : 2];
                const std::uint32_t entry =
                    entries[leaf * 384 + static_cast<std::size_t>(64 * side + line)];
                const auto all = static_cast<int>(std::min(distance + (entry >> 17), 32767u));
                if ((entry & 0xffff) == 1) return {-1, all, oracle::End::nothing};
                const bool front = (entry >> 16 & 1) != 0;
                return oracle::met((entry & 0xffff) | std::uint32_t{front} << (16 + side), side,
                                   all);
            } else {
                cell = cells[leaf * 512 + static_cast<std::size_t>(64 * v[0] + 8 * v[1] + v[2])];
                if (cell == 1) continue;
            }
            return oracle::met(cell, side, static_cast<int>(distance));
        }
    }
    std::uint32_t expected(std::size_t leaf, const std::array<int, 3>& v, std::uint32_t votes,
                           bool columns) const {
        if (cells[leaf * 512 + static_cast<std::size_t>(64 * v[0] + 8 * v[1] + v[2])] != 1)
            return 0;
        std::array<oracle::SixHit, 6> hits;
        for (int side = 0; side < 6; ++side)
            hits[static_cast<std::size_t>(side)] = hit(leaf, v, side);
        return oracle::told(hits, static_cast<int>(votes), columns);
    }
};

class SixFillVote : public EachBackend {
  protected:
    std::vector<std::uint32_t> run(device::Device& on, const VoteCase& c, std::uint32_t votes,
                                   bool columns) {
        using device::Buffer;
        const Buffer<std::uint32_t> cells(on, std::span(c.cells), "cells"),
            entries(on, std::span(c.entries), "entries");
        const Guarded<std::uint32_t> filled(on, c.cells.size(), "filled");
        run_kernel<kernels::SixFillVote>(
            on, c.cells.size(), {.cells = cells, .entries = entries, .filled = filled.slice()},
            {.count = static_cast<std::uint32_t>(c.cells.size()),
             .votes = votes,
             .columns = columns ? 1u : 0u});
        EXPECT_TRUE(filled.untouched());
        return filled.download();
    }
};

TEST_P(SixFillVote, MatchesTheCount) {
    for (const std::uint32_t leaves : {0u, 1u, 2u, 131u}) {
        for (const std::uint32_t votes : {1u, 2u, 3u, 6u}) {
            const VoteCase c(leaves + votes, leaves);
            const bool columns = votes == 2 || votes == 6;
            const auto filled = run(*device, c, votes, columns);
            std::uint64_t wrong = 0;
            for (std::size_t n = 0; n < filled.size(); ++n) {
                const auto at = static_cast<int>(n % 512);
                const std::uint32_t expected =
                    c.expected(n / 512, {at / 64, at / 8 % 8, at % 8}, votes, columns);
                if (filled[n] != expected && ++wrong < 5)
                    ADD_FAILURE() << "voxel " << n << ": " << filled[n] << ", expected "
                                  << expected;
            }
            EXPECT_EQ(wrong, 0u) << leaves << " leaves, " << votes << " votes";
        }
    }
}

TOPPLE_ON_EACH_FORM(SixFillVote);

}  // namespace
}  // namespace topple::test
