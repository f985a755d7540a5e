// SPDX-License-Identifier: MIT
#include "support_function.hpp"

#include <cmath>

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "oracle/support_function_oracle.h"

namespace topple::test {
namespace {

using Vectors = std::vector<std::array<float, 3>>;

std::vector<float> axis_of(const Vectors& vectors, int axis) {
    std::vector<float> out;
    for (const auto& v : vectors) out.push_back(v[axis]);
    return out;
}

Vectors random_points(Random& random, std::size_t count) {
    Vectors out(count);
    for (auto& v : out) v = {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(0, 3)};
    return out;
}

Vectors random_directions(Random& random, std::size_t count) {
    Vectors out = random_points(random, count);
    for (auto& v : out) {
        const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + 1e-6f;
        for (float& c : v) c /= length;
    }
    return out;
}

// Two primitives in one set of vertex arrays; the second one's row, after the first one's.
std::vector<float> second_row(device::Device& device, const Vectors& points, std::uint32_t first,
                              const Vectors& directions) {
    const auto rows = static_cast<std::uint32_t>(directions.size());
    const device::Buffer<float> vx(device, axis_of(points, 0), "vx"),
        vy(device, axis_of(points, 1), "vy"), vz(device, axis_of(points, 2), "vz"),
        dx(device, axis_of(directions, 0), "dx"), dy(device, axis_of(directions, 1), "dy"),
        dz(device, axis_of(directions, 2), "dz");
    const Guarded<float> s(device, 2 * rows, "s");
    const auto args = kernels::SupportFunction::Args{vx, vy, vz, dx, dy, dz, s.slice()};
    device::Queue queue(device);
    queue.add<kernels::SupportFunction>(
        rows, args,
        {.vertex_count = first, .vertex_first = 0, .direction_count = rows, .output_first = 0});
    queue.add<kernels::SupportFunction>(
        rows, args,
        {.vertex_count = static_cast<std::uint32_t>(points.size()) - first,
         .vertex_first = first,
         .direction_count = rows,
         .output_first = rows});
    queue.run();
    EXPECT_TRUE(s.untouched());
    const std::vector<float> both = s.download();
    return {both.begin() + rows, both.end()};
}

class SupportFunction : public EachBackend {};
TOPPLE_ON_EACH_FORM(SupportFunction);

TEST_P(SupportFunction, MatchesTheOracleAndTheNativeBackendsBits) {
    const auto native = device::open_native();
    Random random(7);
    for (const std::size_t lanes : {0u, 1u, 63u, 64u, 65u, 101u}) {
        for (const std::size_t vertices : {1u, 2u, 61u}) {
            SCOPED_TRACE(std::to_string(lanes) + " work-items, " + std::to_string(vertices) +
                         " vertices");
            // Directions are padded to a multiple of the items per work-item: 32 is one for all
            // backends.
            const Vectors directions = random_directions(random, 32 * lanes);
            const Vectors points = random_points(random, vertices + 5);
            const std::vector<float> got = second_row(*device, points, 5, directions);
            std::vector<double> want, bound;
            oracle::support_function({points.begin() + 5, points.end()}, directions, want, bound);
            EXPECT_TRUE(within(got, want, bound));
            EXPECT_TRUE(same(got, second_row(*native, points, 5, directions)));
        }
    }
}

// The lowest point of a unit cube about the origin lies |d|_1 / 2 below it.
TEST_P(SupportFunction, OfACubeIsHalfTheTaxicabNorm) {
    Vectors cube;
    for (int corner = 0; corner < 8; ++corner) {
        cube.push_back(
            {corner & 1 ? 0.5f : -0.5f, corner & 2 ? 0.5f : -0.5f, corner & 4 ? 0.5f : -0.5f});
    }
    Random random(3);
    const Vectors directions = random_directions(random, 320);
    const std::vector<float> got = second_row(*device, cube, 0, directions);
    std::vector<double> want, bound(directions.size(), 1e-6);
    for (const auto& d : directions) {
        want.push_back(-0.5 *
                       (std::abs(double{d[0]}) + std::abs(double{d[1]}) + std::abs(double{d[2]})));
    }
    EXPECT_TRUE(within(got, want, bound));
}

}  // namespace
}  // namespace topple::test
