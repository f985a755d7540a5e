// SPDX-License-Identifier: MIT
#include "group_landscape.hpp"

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "oracle/group_landscape_oracle.h"
#include "oracle/steepest_descent_oracle.h"
#include "oracle/support_function_oracle.h"
#include "steepest_descent.hpp"
#include "support_function.hpp"

namespace topple::test {
namespace {

// Random table rows and groups; the directions come in two tiles of different size.
struct LandscapeCase {
    std::uint32_t candidates, rows;
    std::uint32_t tile[2] = {128, 256};
    std::vector<float> axis[3], s[2], offset[3];
    std::vector<std::uint32_t> first{0}, row;

    LandscapeCase(std::uint32_t candidate_count, std::uint32_t row_count)
        : candidates(candidate_count), rows(row_count) {
        Random random(candidates * 31 + rows);
        for (auto& a : axis) a = random.floats(tile[0] + tile[1], -1, 1);
        for (int t = 0; t < 2; ++t) s[t] = random.floats(std::size_t{rows} * tile[t], -2, 2);
        for (std::uint32_t c = 0; c < candidates; ++c) {
            const std::uint32_t members = 1 + random.word() % 7;
            for (std::uint32_t m = 0; m < members; ++m) row.push_back(random.word() % rows);
            first.push_back(static_cast<std::uint32_t>(row.size()));
        }
        for (auto& o : offset) o = random.floats(row.size(), -3, 3);
    }
    std::uint32_t directions() const { return tile[0] + tile[1]; }
    std::vector<float> part(int a, int t) const {
        const auto from = axis[a].begin() + (t ? tile[0] : 0);
        return {from, from + tile[t]};
    }
};

class GroupLandscape : public EachBackend {
  protected:
    std::vector<float> run(device::Device& on, const LandscapeCase& c) {
        const device::Buffer<std::uint32_t> first(on, c.first, "first"), row(on, c.row, "row");
        const device::Buffer<float> ox(on, c.offset[0], "ox"), oy(on, c.offset[1], "oy"),
            oz(on, c.offset[2], "oz");
        const Guarded<float> energy(on, std::uint64_t{c.candidates} * c.directions(), "energy");
        for (int t = 0; t < 2; ++t) {
            const device::Buffer<float> s(on, c.s[t], "s"), dx(on, c.part(0, t), "dx"),
                dy(on, c.part(1, t), "dy"), dz(on, c.part(2, t), "dz");
            run_kernel<kernels::GroupLandscape>(on, std::uint64_t{c.candidates} * c.tile[t],
                                                {.s = s,
                                                 .dx = dx,
                                                 .dy = dy,
                                                 .dz = dz,
                                                 .first = first,
                                                 .row = row,
                                                 .ox = ox,
                                                 .oy = oy,
                                                 .oz = oz,
                                                 .energy = energy.slice()},
                                                {.candidate_count = c.candidates,
                                                 .tile_directions = c.tile[t],
                                                 .padded_directions = c.directions(),
                                                 .tile_first = t ? c.tile[0] : 0});
        }
        EXPECT_TRUE(energy.untouched());
        return energy.download();
    }
};
TOPPLE_ON_EACH_FORM(GroupLandscape);

TEST_P(GroupLandscape, MatchesTheOracleAndNativeToTheBit) {
    const auto native = device::open_native();
    for (const std::uint32_t candidates : {0u, 1u, 2u, 63u, 64u, 65u, 101u}) {
        SCOPED_TRACE(candidates);
        const LandscapeCase c(candidates, 13);
        std::vector<double> want, bound;
        for (std::uint32_t n = 0; n < candidates; ++n) {
            for (std::uint32_t d = 0; d < c.directions(); ++d) {
                const int t = d >= c.tile[0];
                std::vector<oracle::LandscapeMember> members;
                for (std::uint32_t m = c.first[n]; m < c.first[n + 1]; ++m) {
                    members.push_back({c.s[t][c.row[m] * c.tile[t] + d - (t ? c.tile[0] : 0)],
                                       {c.offset[0][m], c.offset[1][m], c.offset[2][m]}});
                }
                double height = 0, most = 0;
                oracle::group_height(members, {c.axis[0][d], c.axis[1][d], c.axis[2][d]}, height,
                                     most);
                want.push_back(height);
                bound.push_back(most);
            }
        }
        const std::vector<float> got = run(*device, c);
        EXPECT_TRUE(within(got, want, bound));
        EXPECT_TRUE(same(got, run(*native, c)));
    }
}

class SteepestDescent : public EachBackend {
  protected:
    // A torus of triangles, six neighbours each, padded to whole blocks.
    void check(std::uint32_t width, std::uint32_t height, std::uint32_t candidates, bool coarse) {
        const std::uint32_t size = width * height, padded = (size + 127) / 128 * 128;
        std::vector<std::uint32_t> neighbour(std::size_t{size} * 6),
            planes(std::size_t{padded} * 6);
        const int steps[6][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}};
        for (std::uint32_t v = 0; v < padded; ++v) {
            for (std::uint32_t k = 0; k < 6; ++k) {
                std::uint32_t w = v;
                if (v < size) {
                    const std::uint32_t x =
                        (v % width + width + static_cast<std::uint32_t>(steps[k][0])) % width;
                    const std::uint32_t y =
                        (v / width + height + static_cast<std::uint32_t>(steps[k][1])) % height;
                    w = y * width + x;
                    neighbour[v * 6 + k] = w;
                }
                planes[std::size_t{k} * padded + v] = w;
            }
        }
        Random random(size + candidates);
        std::vector<float> energy = random.floats(std::size_t{padded} * candidates, -1, 1);
        if (coarse) {  // plateaus and ties
            for (float& e : energy) e = std::floor(e * 4) / 4;
        }
        const device::Buffer<float> energy_buffer(*device, energy, "energy");
        const device::Buffer<std::uint32_t> neighbours(*device, planes, "neighbour");
        const Guarded<std::uint32_t> down(*device, energy.size(), "down");
        run_kernel<kernels::SteepestDescent>(
            *device, energy.size(),
            {.energy = energy_buffer, .neighbour = neighbours, .down = down.slice()},
            {.candidate_count = candidates, .padded_directions = padded});
        std::vector<std::uint32_t> want;
        for (std::uint32_t n = 0; n < candidates; ++n) {
            const auto from = energy.begin() + static_cast<std::ptrdiff_t>(n) * padded;
            const auto row = oracle::steepest_descent({from, from + size}, neighbour, 6);
            want.insert(want.end(), row.begin(), row.end());
            for (std::uint32_t v = size; v < padded; ++v) want.push_back(v);  // padding
        }
        EXPECT_TRUE(same(down.download(), want));
        EXPECT_TRUE(down.untouched());
    }
};
TOPPLE_ON_EACH_FORM(SteepestDescent);

TEST_P(SteepestDescent, MatchesTheOracle) {
    check(7, 5, 0, false);
    for (const auto& [width, height] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{
             {1, 1}, {127, 1}, {16, 8}, {43, 3}, {31, 29}}) {
        SCOPED_TRACE(width * height);
        for (const std::uint32_t candidates : {1u, 3u, 17u})
            check(width, height, candidates, candidates == 3);
    }
}

TEST_P(SteepestDescent, ManyDirections) {
    check(251, 97, 5, false);
    check(251, 97, 5, true);
}

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
