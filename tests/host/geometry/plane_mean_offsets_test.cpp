// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "device/devices.h"
#include "geometry/plane_fit.h"

namespace topple::geometry {
namespace {

// The cells that points of a surface lie in, each with their mean.
CellGrid grid_of(const std::vector<std::array<double, 3>>& points) {
    std::map<std::array<std::int32_t, 3>, std::array<double, 4>> cells;
    for (const auto& p : points) {
        std::array<std::int32_t, 3> at{};
        for (std::size_t a = 0; a < 3; ++a) at[a] = static_cast<std::int32_t>(std::floor(p[a]));
        auto& sum = cells[at];
        for (std::size_t a = 0; a < 3; ++a) sum[a] += p[a] - at[a] - 0.5;
        sum[3] += 1;
    }
    CellGrid out;
    out.cell_m = 1;
    out.resize(cells.size());
    std::size_t n = 0;
    for (const auto& [at, sum] : cells) {
        out.x[n] = at[0], out.y[n] = at[1], out.z[n] = at[2];
        out.weight[n] = 1;
        for (std::size_t a = 0; a < 3; ++a) out.mean[a][n] = static_cast<float>(sum[a] / sum[3]);
        ++n;
    }
    return out;
}

// How far outside of a tube about z its cells' means are moved to, by planes or by their mean.
double off_tube(double radius, double noise, bool with_mean) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> turn(0, 2 * std::numbers::pi), along(-12, 12);
    std::normal_distribution<double> off(0, noise);
    std::vector<std::array<double, 3>> points;
    for (int n = 0; n < 40000; ++n) {
        const double a = turn(random), r = radius + off(random);
        points.push_back({r * std::cos(a) + 0.3, r * std::sin(a) + 0.1, along(random)});
    }
    const CellGrid grid = grid_of(points);
    const auto device = device::open_native();
    const PlaneQueries queries = queries_at_means(grid);
    PlaneFitter fitter(*device, grid, queries);
    const PlaneFit fit = fitter.fit({});
    const std::vector<float> offset = with_mean ? fitter.mean_offsets(fit) : fit.offset;
    double out = 0, count = 0;
    for (std::size_t q = 0; q < queries.cell.size(); ++q) {
        const std::size_t c = queries.cell[q];
        if (std::abs(grid.z[c]) > 7) continue;
        const double x = grid.x[c] + 0.5 + queries.at[0][q] + offset[q] * fit.normal[0][q] - 0.3,
                     y = grid.y[c] + 0.5 + queries.at[1][q] + offset[q] * fit.normal[1][q] - 0.1;
        out += std::hypot(x, y) - radius;
        ++count;
    }
    return out / count;
}

TEST(PlaneMean, DoesNotShrinkWhatIsRound) {
    for (const double radius : {6.0, 12.0, 24.0}) {
        const double plane = off_tube(radius, 0.05, false), mean = off_tube(radius, 0.05, true);
        EXPECT_LT(plane, -0.3 / radius) << "a plane alone does, radius " << radius;
        EXPECT_LT(std::abs(mean), 0.15 * std::abs(plane)) << radius;
    }
}

}  // namespace
}  // namespace topple::geometry
