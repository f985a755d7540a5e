// SPDX-License-Identifier: MIT
#include "group_stance.hpp"

#include "errors.h"
#include "oracle/group_stance_oracle.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::test {
namespace {

class GroupStance : public EachBackend {};
TOPPLE_ON_EACH_FORM(GroupStance);

TEST_P(GroupStance, MatchesTheOracle) {
    for (const auto& [groups, directions] :
         {std::array{0u, 32u}, {1u, 16u}, {63u, 64u}, {64u, 32u}, {65u, 64u}, {997u, 64u}}) {
        SCOPED_TRACE(testing::Message() << groups << " groups, " << directions << " directions");
        Random random(groups + directions);
        constexpr std::uint32_t rows = 29;
        std::vector<float> reach, ux, uy, cx, cy;
        std::vector<std::vector<double>> reach_rows(rows);
        std::vector<std::array<double, 2>> direction, center;
        for (std::uint32_t d = 0; d < directions; ++d) {
            const double angle = 2 * std::numbers::pi * d / directions;
            ux.push_back(static_cast<float>(std::cos(angle)));
            uy.push_back(static_cast<float>(std::sin(angle)));
            direction.push_back({ux.back(), uy.back()});
        }
        for (std::uint32_t f = 0; f < rows; ++f) {
            const std::vector<float> row = random.floats(directions, -3, 3);
            reach.insert(reach.end(), row.begin(), row.end());
            reach_rows[f].assign(row.begin(), row.end());
        }
        std::vector<std::uint32_t> first{0}, footing;
        std::vector<std::vector<std::uint32_t>> footings;
        for (std::uint32_t g = 0; g < groups; ++g) {
            footings.emplace_back();
            for (std::uint32_t n = random.word() % 6; n > 0; --n)
                footings.back().push_back(random.word() % rows);
            footing.insert(footing.end(), footings.back().begin(), footings.back().end());
            first.push_back(static_cast<std::uint32_t>(footing.size()));
            const std::vector<float> c = random.floats(2, -4, 4);
            cx.push_back(c[0]);
            cy.push_back(c[1]);
            center.push_back({c[0], c[1]});
        }
        if (footing.empty()) footing.push_back(0);
        if (cx.empty()) cx = cy = {0};
        const device::Buffer<float> table(*device, reach, "reach"), x(*device, ux, "ux"),
            y(*device, uy, "uy"), at_x(*device, cx, "cx"), at_y(*device, cy, "cy");
        const device::Buffer<std::uint32_t> firsts(*device, first, "first"),
            list(*device, footing, "footing");
        const Guarded<float> margin(*device, groups, "margin");
        run_kernel<kernels::GroupStance>(*device, groups,
                                         {.reach = table,
                                          .ux = x,
                                          .uy = y,
                                          .first = firsts,
                                          .footing = list,
                                          .cx = at_x,
                                          .cy = at_y,
                                          .margin = margin.slice()},
                                         {.groups = groups, .directions = directions});
        std::vector<double> want, bound;
        oracle::group_stance(reach_rows, direction, footings, center, want, bound);
        EXPECT_TRUE(within(margin.download(), want, bound));
        EXPECT_TRUE(margin.untouched());
    }
}

}  // namespace
}  // namespace topple::test
