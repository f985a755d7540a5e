// SPDX-License-Identifier: MIT
#include "group_landscape.hpp"

#include "device/queue.h"
#include "device_compare.h"
#include "device_harness.h"
#include "oracle/group_landscape_oracle.h"

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
            device::Queue queue(on);
            queue.add<kernels::GroupLandscape>(std::uint64_t{c.candidates} * c.tile[t],
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
            queue.run();
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

}  // namespace
}  // namespace topple::test
