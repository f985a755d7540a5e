// SPDX-License-Identifier: MIT
#include "topple/kernels/primitives/sparse_grid.h"

#include "oracle/primitives_oracle.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::test {
namespace {

using oracle::Cell;
using primitives::grid_key;
using primitives::none;
using primitives::SparseGrid;
using Floats = device::Buffer<float>;
using Words = std::vector<std::uint32_t>;

class SparseGrids : public EachBackend {
  protected:
    SparseGrid of(const std::array<std::vector<float>, 3>& points, float edge_m) {
        const Floats x(*device, points[0], "x"), y(*device, points[1], "y"),
            z(*device, points[2], "z");
        return SparseGrid::of_points(*device, x, y, z, edge_m);
    }
    static std::uint64_t key_of(const Cell& c) {
        const auto at = [&](std::size_t a) { return static_cast<std::int32_t>(c[a]); };
        return grid_key(at(0), at(1), at(2));
    }
    static std::vector<std::uint64_t> keys(const SparseGrid::Array& low,
                                           const SparseGrid::Array& high) {
        const Words lows = low.download(), highs = high.download();
        std::vector<std::uint64_t> out;
        for (std::size_t n = 0; n < lows.size(); ++n)
            out.push_back(std::uint64_t{highs[n]} << 32 | lows[n]);
        return out;
    }
    // All of it, and what is asked of it.
    void expect_is(const oracle::CellsByLeaf& want, const SparseGrid& got) {
        std::vector<std::uint64_t> cell_keys, leaf_keys;
        Words first, masks;
        std::map<Cell, std::uint32_t> number;
        for (const auto& [leaf, cells] : want.cells_of_leaf) {
            number.emplace(leaf, number.size());
            leaf_keys.push_back(key_of({8 * leaf[0], 8 * leaf[1], 8 * leaf[2]}));
            first.push_back(static_cast<std::uint32_t>(cell_keys.size()));
            Words mask(16);
            for (const Cell& cell : cells) {
                cell_keys.push_back(key_of(cell));
                std::size_t bit = 0;
                for (std::size_t a = 0; a < 3; ++a)
                    bit = 8 * bit + static_cast<std::size_t>(cell[a] - 8 * leaf[a]);
                mask[bit / 32] |= 1u << bit % 32;
            }
            masks.insert(masks.end(), mask.begin(), mask.end());
        }
        first.push_back(static_cast<std::uint32_t>(cell_keys.size()));
        ASSERT_EQ(got.cells, cell_keys.size());
        ASSERT_EQ(got.leaves, leaf_keys.size());
        EXPECT_TRUE(keys(got.cell_low, got.cell_high) == cell_keys);
        EXPECT_TRUE(keys(got.leaf_low, got.leaf_high) == leaf_keys);
        Words got_first = got.first.download();
        got_first.resize(first.size());
        EXPECT_TRUE(same(got_first, first));
        EXPECT_TRUE(same(got.mask.download(), masks));
        device::Queue queue(*device);
        primitives::Scratch scratch(*device);
        for (const auto& [di, dj, dk] : {std::array{1, 0, 0}, std::array{0, -1, 0},
                                         std::array{0, 0, 1}, std::array{1, -1, 1}}) {
            const Guarded<std::uint32_t> beside(*device, got.leaves, "leaves beside");
            got.neighbours(queue, scratch, di, dj, dk, beside.slice());
            queue.run();
            Words wanted;
            for (const auto& [leaf, cells] : want.cells_of_leaf) {
                const auto at = number.find({leaf[0] + di, leaf[1] + dj, leaf[2] + dk});
                wanted.push_back(at == number.end() ? none : at->second);
            }
            EXPECT_TRUE(same(beside.download(), wanted));
            EXPECT_TRUE(beside.untouched());
        }
    }
};
TOPPLE_ON_EACH_FORM(SparseGrids);

TEST_P(SparseGrids, OfPointsAreTheOracles) {
    for (const std::size_t count : {0, 1, 2, 63, 1000, 65'537}) {
        for (const float reach : {0.3F, 3.0F, 2000.0F}) {
            SCOPED_TRACE(testing::Message() << count << " points within " << reach);
            Random random(count);
            std::array<std::vector<float>, 3> points;
            std::vector<Cell> cells;
            constexpr float edge_m = 0.0625F;  // of which the quotient is exact
            for (std::size_t n = 0; n < count; ++n) {
                Cell cell;
                for (std::size_t a = 0; a < 3; ++a) {
                    points[a].push_back(random.uniform(-reach, reach));
                    cell[a] =
                        static_cast<std::int64_t>(std::floor(double{points[a].back()} / edge_m));
                }
                cells.push_back(cell);
            }
            const oracle::CellsByLeaf want(cells);
            const SparseGrid got = of(points, edge_m);
            expect_is(want, got);
            if (count <= 1000) expect_is(want.dilated(), got.dilated());
        }
    }
}

TEST_P(SparseGrids, LeaveOutWhatIsNoPlaceOrTooFar) {
    const float nan = std::nanf(""), far = 1048576, inside = 1048575;
    const SparseGrid got = of({{{nan, 0, HUGE_VALF, far, -far, inside, -inside, 0.5F},
                                {0, 0, 0, 0, 0, 0, 0, 0.25F},
                                {0, -HUGE_VALF, 0, 0, 0, 0, 0, 0.75F}}},
                              1);
    const std::vector<Cell> cells{{1048575, 0, 0}, {-1048575, 0, 0}, {0, 0, 0}};
    const oracle::CellsByLeaf want(cells);
    expect_is(want, got);
    expect_is(want.dilated(), got.dilated());
    const std::string message = message_of([&] { of({}, 0); }, ErrorKind::usage);
    EXPECT_THAT(message, ::testing::HasSubstr("edge_m"));
}

TEST_P(SparseGrids, FindTheirCells) {
    Random random(7);
    std::array<std::vector<float>, 3> points;
    for (std::size_t n = 0; n < 5000; ++n)
        for (auto& axis : points) axis.push_back(random.uniform(-1, 1));
    const SparseGrid grid = of(points, 0.125F);
    const std::vector<std::uint64_t> all = keys(grid.cell_low, grid.cell_high);
    std::array<std::vector<std::int32_t>, 3> cells;
    Words wanted;
    const std::vector<std::int32_t> ends{INT32_MIN, INT32_MAX, -(1 << 20), 1 << 20, (1 << 20) - 1};
    for (std::size_t n = 0; n < 4099; ++n) {
        for (auto& axis : cells)
            axis.push_back(n < 20 ? ends[random.below(ends.size())]
                                  : static_cast<std::int32_t>(random.below(40)) - 20);
        const auto at = [&](std::size_t a) { return cells[a].back(); };
        const auto found =
            std::ranges::lower_bound(all, n < 20 ? 0 : grid_key(at(0), at(1), at(2)));
        const bool has = n >= 20 && found != all.end() && *found == grid_key(at(0), at(1), at(2));
        wanted.push_back(has ? static_cast<std::uint32_t>(found - all.begin()) : none);
    }
    const auto upload = [&](std::size_t a) {
        return device::Buffer<std::int32_t>(*device, cells[a], "cells");
    };
    const auto i = upload(0), j = upload(1), k = upload(2);
    const Guarded<std::uint32_t> place(*device, wanted.size(), "place");
    device::Queue queue(*device);
    grid.find(queue, i, j, k, place.slice());
    queue.run();
    EXPECT_TRUE(same(place.download(), wanted));
    EXPECT_TRUE(place.untouched());
}

}  // namespace
}  // namespace topple::test
