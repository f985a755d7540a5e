// SPDX-License-Identifier: MIT
#include "disturbance.hpp"

#include "core/random.h"
#include "device/devices.h"
#include "disturbance_reach.hpp"
#include "errors.h"
#include "oracle/disturbance_oracle.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple {
namespace {

using device::Buffer;

// A padded map of random solids and primary motion, random blocks of it, and random footprints.
struct Case {
    static constexpr int width = 256, height = 96, radius = 9;
    std::uint32_t blocks, rows;
    unsigned directions, bands, band_first;

    oracle::Grid grid{width, height, {}};
    std::vector<std::uint32_t> starts, row_first{0};
    std::vector<std::pair<int, int>> offsets;
    std::vector<std::int32_t> step_a, step_b;
    std::vector<float> primary;
    std::vector<std::uint32_t> entry_first{0}, entry_row;
    std::vector<std::int32_t> entry_delta;
    std::vector<float> entry_weight;

    Case(std::uint32_t block_count, std::uint32_t row_count, unsigned direction_total,
         unsigned band_total, unsigned first_band)
        : blocks(block_count),
          rows(row_count),
          directions(direction_total),
          bands(band_total),
          band_first(first_band) {
        Random random(blocks * 7919 + rows * 31 + bands);
        grid.solid.resize(width * height);
        for (auto& word : grid.solid)
            word = static_cast<std::uint32_t>(random.bits() & random.bits() & random.bits());
        for (std::uint32_t b = 0; b < blocks; ++b) {
            const auto row = 10 + random.below(height - 20), column = random.below(width / 64);
            starts.push_back(static_cast<std::uint32_t>(row * width + column * 64));
        }
        for (std::uint32_t r = 0; r < rows; ++r) add_line(random);
        primary.resize(std::size_t{directions} * width * height);
        for (auto& p : primary) p = random.below(3) ? 0.0f : static_cast<float>(random.uniform());
        for (unsigned d = 0; d < directions; ++d) {
            const std::uint64_t count = rows ? random.below(100) : 0;
            for (std::uint64_t e = 0; e < count; ++e) {
                const auto row = random.below(rows);
                entry_row.push_back(static_cast<std::uint32_t>(row));
                entry_delta.push_back(offsets[row].second * width + offsets[row].first);
                entry_weight.push_back(static_cast<float>(random.uniform()));
            }
            entry_first.push_back(static_cast<std::uint32_t>(entry_row.size()));
        }
    }

    void add_line(Random& random) {
        const int ox = static_cast<int>(random.below(2 * radius + 1)) - radius;
        const int oy = static_cast<int>(random.below(2 * radius + 1)) - radius;
        offsets.emplace_back(ox, oy);
        const int n = std::max(std::abs(ox), std::abs(oy));
        int px = 0, py = 0;
        for (int s = 1; s <= n; ++s) {
            const int x = static_cast<int>(std::round(double(ox) * s / n));
            const int y = static_cast<int>(std::round(double(oy) * s / n));
            if (x != px && y != py) {
                step_a.push_back(py * width + x);
                step_b.push_back(y * width + px);
            }
            if (s < n) {
                step_a.push_back(y * width + x);
                step_b.push_back(y * width + x);
            }
            px = x;
            py = y;
        }
        row_first.push_back(static_cast<std::uint32_t>(step_a.size()));
    }

    std::uint32_t cells() const { return blocks * 64; }
    std::uint32_t map_cell(std::uint32_t cell) const { return starts[cell / 64] + cell % 64; }
};

std::vector<std::uint32_t> run_reach(device::Device& device, const Case& c) {
    const std::uint64_t outputs = std::uint64_t{c.rows} * c.cells();
    Buffer<std::uint32_t> starts(device, c.starts, "starts"), solid(device, c.grid.solid, "solid"),
        first(device, c.row_first, "first");
    const test::Guarded<std::uint32_t> blocked(device, outputs, "blocked");
    Buffer<std::int32_t> a(device, c.step_a, "a"), b(device, c.step_b, "b");
    test::run_kernel<kernels::DisturbanceReach>(device, outputs,
                                                {.block_start = starts,
                                                 .solid = solid,
                                                 .row_first = first,
                                                 .step_a = a,
                                                 .step_b = b,
                                                 .blocked = blocked.slice()},
                                                {.cell_count = c.cells(), .row_count = c.rows});
    EXPECT_TRUE(blocked.untouched());
    return blocked.download();
}

std::vector<float> run_convolution(device::Device& device, const Case& c,
                                   const std::vector<std::uint32_t>& blocked_words) {
    const std::uint64_t outputs = std::uint64_t{c.directions} * c.bands * c.cells();
    Buffer<std::uint32_t> starts(device, c.starts, "starts"),
        blocked(device, blocked_words, "blocked"), first(device, c.entry_first, "first"),
        row(device, c.entry_row, "row");
    Buffer<std::int32_t> delta(device, c.entry_delta, "delta");
    Buffer<float> primary(device, c.primary, "primary"), weight(device, c.entry_weight, "weight");
    const test::Guarded<float> density(device, outputs, "density");
    test::run_kernel<kernels::Disturbance>(
        device, std::uint64_t{c.directions} * ((c.bands + 3) / 4) * c.cells(),
        {.block_start = starts,
         .primary = primary,
         .blocked = blocked,
         .entry_first = first,
         .entry_delta = delta,
         .entry_row = row,
         .entry_weight = weight,
         .density = density.slice()},
        {.cell_count = c.cells(),
         .row_count = c.rows,
         .plane_cells = Case::width * Case::height,
         .direction_count = c.directions,
         .footprint_first = 0,
         .band_first = c.band_first,
         .band_count = c.bands,
         .output_first = 0});
    EXPECT_TRUE(density.untouched());
    return density.download();
}

// Groups take 64 x ITEMS cells: these sizes lie below, at and above one group on every backend.
const Case& shape(int n) {
    static const std::vector<Case> all{{0, 3, 2, 4, 0},  {1, 0, 1, 1, 0},     {1, 1, 1, 1, 31},
                                       {2, 3, 3, 2, 5},  {31, 1, 1, 3, 29},   {32, 7, 1, 4, 28},
                                       {33, 5, 2, 5, 3}, {61, 13, 16, 13, 8}, {7, 37, 5, 9, 23}};
    return all[n];
}
constexpr int shapes = 9;

class DisturbanceKernels : public test::EachBackend {};

TEST_P(DisturbanceKernels, ReachIsExact) {
    const auto native = device::open_native();
    for (int n = 0; n < shapes; ++n) {
        const Case& c = shape(n);
        const auto got = run_reach(*device, c);
        EXPECT_TRUE(test::same(got, run_reach(*native, c)));
        std::size_t shut = 0;
        for (std::uint32_t cell = 0; cell < c.cells(); ++cell) {
            const int x = static_cast<int>(c.map_cell(cell) % Case::width);
            const int y = static_cast<int>(c.map_cell(cell) / Case::width);
            for (std::uint32_t row = 0; row < c.rows; ++row) {
                const auto [ox, oy] = c.offsets[row];
                // Lines that leave the map's rows wrap around; the host never uses those cells.
                if (x + ox < 0 || x + ox >= Case::width) continue;
                const std::uint32_t want = oracle::shut_between(c.grid, x, y, x + ox, y + oy);
                const std::uint32_t word =
                    got[(std::size_t{cell / 64} * c.rows + row) * 64 + cell % 64];
                shut += want != 0;
                ASSERT_EQ(word, want) << "case " << n << ", row " << row << ", cell " << cell;
            }
        }
        if (c.rows >= 3 && c.blocks > 0) {
            EXPECT_GT(shut, 0u) << "case " << n << " tests nothing";
        }
    }
}

TEST_P(DisturbanceKernels, DensityWithinItsBoundAndNativeToTheBit) {
    const auto native = device::open_native();
    for (int n = 0; n < shapes; ++n) {
        const Case& c = shape(n);
        std::vector<std::uint32_t> blocked(std::size_t{c.rows} * c.cells());
        Random random(5);
        for (auto& word : blocked) word = static_cast<std::uint32_t>(random.bits() & random.bits());
        const auto got = run_convolution(*device, c, blocked);
        EXPECT_TRUE(test::same(got, run_convolution(*native, c, blocked)));
        double worst = 0;
        std::size_t at = 0, positive = 0;
        for (unsigned d = 0; d < c.directions; ++d) {
            std::vector<oracle::Entry> entries;
            for (auto e = c.entry_first[d]; e < c.entry_first[d + 1]; ++e)
                entries.push_back({c.entry_delta[e], c.entry_row[e], c.entry_weight[e]});
            for (unsigned b = 0; b < c.bands; ++b) {
                for (std::uint32_t cell = 0; cell < c.cells(); ++cell, ++at) {
                    const std::size_t from =
                        std::size_t{d} * Case::width * Case::height + c.map_cell(cell);
                    const double want = oracle::gather(entries, c.primary, from, blocked, c.rows,
                                                       cell, c.band_first + b);
                    if (want == 0) {
                        ASSERT_EQ(got[at], 0.0f) << "case " << n << ": unreached, but not zero";
                        continue;
                    }
                    ++positive;
                    worst = std::max(worst, std::fabs(got[at] - want) / want);
                    ASSERT_LE(worst, 1e-4)
                        << "case " << n << ", direction " << d << ", band " << b << ", cell "
                        << cell << ": " << got[at] << " for " << want;
                }
            }
        }
        if (c.blocks > 0 && c.rows > 1) {
            EXPECT_GT(positive, 0u) << "case " << n << " tests nothing";
        }
        EXPECT_LE(worst, 101 * 0x1p-24);
    }
}

TOPPLE_ON_EACH_FORM(DisturbanceKernels);

}  // namespace
}  // namespace topple
