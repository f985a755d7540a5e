// SPDX-License-Identifier: MIT
#include "voxel_normals.hpp"

#include "columns_by_trial.h"
#include "device/devices.h"
#include "errors.h"
#include "oracle/plane_mean_oracle.h"
#include "oracle/voxel_normals_oracle.h"
#include "plane_mean.hpp"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::test {
namespace {

using oracle::PlaneCell;

// Cells on a wavy sheet with some strays above it, so that columns hold none, one and several.
std::vector<PlaneCell> sheet(std::size_t count, Random& random, bool noise) {
    std::map<std::array<int, 3>, PlaneCell> cells;
    const int side = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(count))));
    for (int n = 0; cells.size() < count; ++n) {
        const int x = n % side, y = n / side % (side + 1);
        const double height = 3 * std::sin(0.3 * x) + 0.4 * y;
        const int z = static_cast<int>(std::floor(height)) +
                      (n / side > side ? static_cast<int>(random.word() % 7) - 2 : 0);
        PlaneCell cell;
        cell.index = {x - 5, y - 3, z};
        // Values that floats hold, so that oracle and kernel see the same.
        const auto value = [&](float low, float high) { return double{random.uniform(low, high)}; };
        cell.weight = value(0.1f, 1);
        cell.mean = {value(-0.5f, 0.5f), value(-0.5f, 0.5f), value(-0.5f, 0.5f)};
        if (noise) {
            const Eigen::Vector3d d(value(-0.3f, 0.3f), value(-0.3f, 0.3f), value(-0.1f, 0.1f));
            cell.spread = (d * d.transpose()).cast<float>().cast<double>();
        }
        cell.prior = Eigen::Vector3d(value(-1, 1), value(-1, 1), 1.5)
                         .normalized()
                         .cast<float>()
                         .cast<double>();
        if (n % 11 == 0) cell.prior.setZero();
        cells[cell.index] = cell;
    }
    std::vector<PlaneCell> list;
    for (const auto& [index, cell] : cells) list.push_back(cell);
    return list;
}

// The kernel's inputs, the columns by trying all cells.
struct Inputs {
    std::vector<float> cells, query, prior;
    std::vector<std::int32_t> z;
    std::vector<std::uint32_t> columns, home;
    std::size_t queries = 0;
};

Inputs inputs_for(const std::vector<PlaneCell>& cells, std::size_t queries, int radius,
                  Random& random) {
    Inputs in;
    const std::size_t n = cells.size();
    in.queries = queries;
    for (int plane = 0; plane < 10; ++plane) {
        for (const PlaneCell& c : cells) {
            const std::array<double, 10> values{
                c.weight,       c.mean[0],      c.mean[1],      c.mean[2],      c.spread(0, 0),
                c.spread(1, 1), c.spread(2, 2), c.spread(0, 1), c.spread(0, 2), c.spread(1, 2)};
            in.cells.push_back(static_cast<float>(values[plane]));
        }
    }
    for (int a = 0; a < 3; ++a) {
        for (const PlaneCell& c : cells) in.prior.push_back(static_cast<float>(c.prior[a]));
    }
    for (const PlaneCell& c : cells) in.z.push_back(c.index[2]);
    in.query.resize(3 * queries);
    for (std::size_t q = 0; q < queries; ++q) {
        // An even number of them stand at the first cells and at the last ones in a row, as on a
        // surface.
        const std::size_t in_row = q < queries / 2 ? q : n - queries + q;
        in.home.push_back(
            static_cast<std::uint32_t>(queries % 2 == 0 ? in_row : random.word() % n));
        for (std::size_t a = 0; a < 3; ++a) in.query[a * queries + q] = random.uniform(-0.5f, 0.5f);
    }
    in.columns = columns_by_trial(cells, in.home, radius);
    return in;
}

std::vector<float> run(device::Device& device, const Inputs& in, std::size_t cells, int radius,
                       bool use_prior) {
    const device::Buffer<float> d_cells(device, in.cells, "cells"),
        d_query(device, in.query, "query"), d_prior(device, in.prior, "prior");
    const device::Buffer<std::int32_t> d_z(device, in.z, "cell_z");
    const device::Buffer<std::uint32_t> d_columns(device, in.columns, "columns"),
        d_home(device, in.home, "home");
    const Guarded<float> fit(device, 6 * in.queries, "fit");
    const float reach = static_cast<float>(radius) + 0.5f;
    run_kernel<kernels::VoxelNormals>(device, in.queries,
                                      {.cells = d_cells,
                                       .cell_z = d_z,
                                       .columns = d_columns,
                                       .query_cell = d_home,
                                       .query = d_query,
                                       .prior = d_prior,
                                       .fit = fit.slice()},
                                      {.query_count = static_cast<std::uint32_t>(in.queries),
                                       .cell_count = static_cast<std::uint32_t>(cells),
                                       .radius = radius,
                                       .inverse_reach2 = 1.0f / (reach * reach),
                                       .use_prior = use_prior ? 1u : 0u});
    EXPECT_TRUE(fit.untouched());
    return fit.download();
}

class VoxelNormals : public EachBackend {};
TOPPLE_ON_EACH_FORM(VoxelNormals);

TEST_P(VoxelNormals, MatchesTheOracleAndNativeToTheBit) {
    const auto native = device::open_native();
    for (const int radius : {1, 2, 3}) {
        for (const std::size_t queries : {0, 1, 63, 64, 65, 331}) {
            for (const bool use_prior : {false, true}) {
                SCOPED_TRACE(testing::Message() << "radius " << radius << " queries " << queries
                                                << " prior " << use_prior);
                Random random(queries + static_cast<std::size_t>(radius));
                const std::vector<PlaneCell> cells = sheet(300, random, radius != 1);
                const Inputs in = inputs_for(cells, queries, radius, random);
                const std::vector<float> got = run(*device, in, cells.size(), radius, use_prior);
                EXPECT_TRUE(same(got, run(*native, in, cells.size(), radius, use_prior)));
                double worst_turn = 0, worst_rms = 0, worst_offset = 0;
                std::size_t clear = 0;
                for (std::size_t q = 0; q < queries; ++q) {
                    const Eigen::Vector3d at(in.query[q], in.query[q + queries],
                                             in.query[q + 2 * queries]);
                    const oracle::Plane want =
                        oracle::fit_plane(cells, in.home[q], at, radius, use_prior);
                    const Eigen::Vector3d n(got[q], got[q + queries], got[q + 2 * queries]);
                    EXPECT_EQ(static_cast<int>(got[q + 5 * queries]), want.used) << q;
                    worst_rms = std::max(worst_rms, std::abs(got[q + 3 * queries] - want.rms));
                    // Where two directions are as thin, neither is the normal; on the verge of a
                    // line, rounding decides.
                    if (want.gap < 0.02 || std::abs(want.line - 1e-3) < 1e-4) continue;
                    EXPECT_NEAR(n.norm(), want.normal.norm(), 1e-5) << q;
                    if (want.normal.isZero()) continue;
                    ++clear;
                    worst_turn = std::max(worst_turn, n.cross(want.normal).norm());
                    const double sign = n.dot(want.normal) < 0 ? -1 : 1;
                    worst_offset =
                        std::max(worst_offset, std::abs(sign * got[q + 4 * queries] - want.offset));
                }
                // Rounding of sums of up to 9 cells^2, over the square root's steepest part.
                EXPECT_LT(worst_rms, 4e-3);
                EXPECT_LT(worst_turn, 2e-3);
                EXPECT_LT(worst_offset, 4e-3);
                EXPECT_GE(2 * clear + 10, queries);
            }
        }
    }
}

// One cell, two cells, a line of cells, the same cell's points all in one place: no plane.
TEST_P(VoxelNormals, GivesNoNormalWhereThereIsNoPlane) {
    for (const std::size_t count : {1u, 2u, 5u}) {
        std::vector<PlaneCell> cells(count);
        for (std::size_t i = 0; i < count; ++i) {
            cells[i].index = {0, 0, static_cast<int>(i)};
            cells[i].weight = 1;
        }
        Random random(count);
        Inputs in = inputs_for(cells, count, 2, random);
        std::fill(in.query.begin(), in.query.end(), 0.0f);
        const std::vector<float> got = run(*device, in, count, 2, false);
        for (std::size_t k = 0; k < 3 * count; ++k)
            EXPECT_EQ(got[k], 0) << count << " cells, value " << k;
    }
}

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
    run_kernel<kernels::PlaneMean>(device, queries,
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
