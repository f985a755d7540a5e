// SPDX-License-Identifier: MIT
#include "plane_mean.hpp"

#include <algorithm>
#include <map>

#include "columns_by_trial.h"
#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "oracle/plane_mean_oracle.h"

namespace topple::test {
namespace {

using oracle::FittedCell;

constexpr float least_cosine = 0.8f;

// Cells on a wavy sheet with some strays above it, with planes that mostly face alike, some the
// other way, some elsewhere; some cells have none.
std::vector<FittedCell> sheet(std::size_t count, Random& random) {
    std::map<std::array<int, 3>, FittedCell> cells;
    const int side = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(count))));
    const auto value = [&](float low, float high) { return double{random.uniform(low, high)}; };
    for (int n = 0; cells.size() < count; ++n) {
        const int x = n % side, y = n / side % (side + 1);
        const int z = static_cast<int>(std::floor(3 * std::sin(0.3 * x) + 0.4 * y)) +
                      (n / side > side ? static_cast<int>(random.word() % 7) - 2 : 0);
        FittedCell cell;
        cell.index = {x - 5, y - 3, z};
        cell.weight = n % 7 == 0 ? 0 : value(0.1f, 1);
        cell.query = {value(-0.5f, 0.5f), value(-0.5f, 0.5f), value(-0.5f, 0.5f)};
        const double tilt = n % 5 == 0 ? 1 : 0.3;
        cell.normal = Eigen::Vector3d(tilt * value(-1, 1), tilt * value(-1, 1), n % 3 ? 1 : -1)
                          .normalized()
                          .cast<float>()
                          .cast<double>();
        if (n % 11 == 0) cell.normal.setZero();
        cell.offset = value(-0.4f, 0.4f);
        cells[cell.index] = cell;
    }
    std::vector<FittedCell> list;
    for (const auto& [index, cell] : cells) list.push_back(cell);
    return list;
}

struct MeanInputs {
    std::vector<float> planes;
    std::vector<std::int32_t> z;
    std::vector<std::uint32_t> columns, home;
};

// Queries at some of the cells that have planes, the columns by trying all cells.
MeanInputs inputs_for(const std::vector<FittedCell>& cells, std::size_t queries, int radius) {
    MeanInputs in;
    for (int plane = 0; plane < 8; ++plane) {
        for (const FittedCell& c : cells) {
            const std::array<double, 8> values{c.weight,    c.query[0],  c.query[1],  c.query[2],
                                               c.normal[0], c.normal[1], c.normal[2], c.offset};
            in.planes.push_back(static_cast<float>(values[plane]));
        }
    }
    for (const FittedCell& c : cells) in.z.push_back(c.index[2]);
    for (std::uint32_t c = 0; in.home.size() < queries; ++c)
        if (cells[c % cells.size()].weight > 0)
            in.home.push_back(c % static_cast<std::uint32_t>(cells.size()));
    in.columns = columns_by_trial(cells, in.home, radius);
    return in;
}

std::vector<float> run(device::Device& device, const MeanInputs& in, int radius) {
    const std::size_t queries = in.home.size();
    const device::Buffer<float> d_planes(device, in.planes, "planes");
    const device::Buffer<std::int32_t> d_z(device, in.z, "cell_z");
    const device::Buffer<std::uint32_t> d_columns(device, in.columns, "columns"),
        d_home(device, in.home, "home");
    const Guarded<float> offsets(device, queries, "offsets");
    const float reach = static_cast<float>(radius) + 0.5f;
    device::Queue queue(device);
    queue.add<kernels::PlaneMean>(queries,
                                  {.planes = d_planes,
                                   .cell_z = d_z,
                                   .columns = d_columns,
                                   .query_cell = d_home,
                                   .offsets = offsets.slice()},
                                  {.query_count = static_cast<std::uint32_t>(queries),
                                   .cell_count = static_cast<std::uint32_t>(in.z.size()),
                                   .radius = radius,
                                   .reach2 = reach * reach,
                                   .least_cosine = least_cosine});
    queue.run();
    EXPECT_TRUE(offsets.untouched());
    return offsets.download();
}

class PlaneMean : public EachBackend {};
TOPPLE_ON_EACH_FORM(PlaneMean);

TEST_P(PlaneMean, MatchesTheOracleAndNativeToTheBit) {
    const auto native = device::open_native();
    for (const int radius : {1, 2, 3}) {
        for (const std::size_t queries : {0, 1, 63, 64, 65, 331}) {
            SCOPED_TRACE(testing::Message() << "radius " << radius << " queries " << queries);
            Random random(queries + static_cast<std::size_t>(radius));
            const std::vector<FittedCell> cells = sheet(300, random);
            const MeanInputs in = inputs_for(cells, queries, radius);
            const std::vector<float> got = run(*device, in, radius);
            EXPECT_TRUE(same(got, run(*native, in, radius)));
            std::vector<double> want, bound;
            std::size_t clear = 0;
            for (std::size_t q = 0; q < queries; ++q) {
                const oracle::PlaneMean mean =
                    oracle::plane_mean(cells, in.home[q], radius, least_cosine);
                want.push_back(mean.offset);
                // Some thirty roundings of each term, and of the sums of 343 at most; on the verge
                // of the angle rounding decides.
                const bool told = mean.verge > 1e-6;
                clear += told;
                bound.push_back(told ? 400 * 0x1p-24 * mean.scale : HUGE_VAL);
            }
            EXPECT_TRUE(within(got, want, bound));
            EXPECT_GE(clear + 5, queries);
        }
    }
}

// Of a cell whose plane nobody shares, not even itself, its own distance stays.
TEST_P(PlaneMean, KeepsTheOwnPlaneWhereNoOtherCounts) {
    FittedCell alone;
    alone.weight = 1;
    alone.offset = 0.25;
    const std::vector<FittedCell> cells{alone};
    EXPECT_EQ(run(*device, inputs_for(cells, 1, 2), 2), std::vector<float>{0.25f});
}

}  // namespace
}  // namespace topple::test
