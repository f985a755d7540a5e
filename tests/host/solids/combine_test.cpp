// SPDX-License-Identifier: MIT
#include "solids/combine.h"

#include "host/solids/boxes.h"
#include "testing.h"

namespace topple::solids {
namespace {

constexpr double voxel = 0.02;
const Vec3 middle{0.01, 0.01, 0.01};

SeenPatch seen(std::uint32_t patch, const Vec3& mean, double here = 10) {
    return {patch, here + 5, here, mean};
}

// Whether a point of the voxel is solid by what was combined.
bool solid(const Combination& sum, std::span<const SurfacePatch> patches, const Vec3& p) {
    BoundaryCells b;
    b.patches.assign(patches.begin(), patches.end());
    b.i = b.j = b.k = b.primitive = {0};
    for (std::size_t s = 0; s < BoundaryCells::slots; ++s) b.slot[s] = {sum.slot[s]};
    b.form = {make_form(sum.any_group, sum.use, sum.used)};
    return b.solid(0, p, 0);
}

TEST(Combine, AtAConvexEdgeBothBoundAndAtAConcaveOneEither) {
    const std::vector<SurfacePatch> patches{plane({0.012, 0, 0}, {1, 0, 0}),
                                            plane({0, 0, 0.011}, {0, 0, 1})};
    // Each was seen inside of the other.
    const Combination convex =
        combine(std::vector{seen(0, {0.012, 0.01, 0.004}), seen(1, {0.004, 0.01, 0.011})}, patches,
                middle, voxel);
    EXPECT_TRUE(solid(convex, patches, {0.005, 0.01, 0.005}));
    EXPECT_FALSE(solid(convex, patches, {0.005, 0.01, 0.015}));
    EXPECT_FALSE(solid(convex, patches, {0.015, 0.01, 0.005}));
    // Each was seen outside of the other.
    const Combination concave =
        combine(std::vector{seen(0, {0.012, 0.01, 0.018}), seen(1, {0.018, 0.01, 0.011})}, patches,
                middle, voxel);
    EXPECT_TRUE(solid(concave, patches, {0.005, 0.01, 0.015}));
    EXPECT_TRUE(solid(concave, patches, {0.015, 0.01, 0.005}));
    EXPECT_FALSE(solid(concave, patches, {0.015, 0.01, 0.015}));
}

// Two parallel faces one behind the other: of a thin board both bound, of a step in one voxel the
// one that was seen there does.
TEST(Combine, ParallelFacesAreABoardOrAStep) {
    const std::vector<SurfacePatch> board{plane({0, 0, 0.015}, {0, 0, 1}),
                                          plane({0, 0, 0.005}, {0, 0, -1})};
    const Combination both =
        combine(std::vector{seen(0, {0.01, 0.01, 0.015}), seen(1, {0.01, 0.01, 0.005})}, board,
                middle, voxel);
    EXPECT_EQ(both.used, 2u);
    EXPECT_TRUE(solid(both, board, {0.01, 0.01, 0.01}));
    EXPECT_FALSE(solid(both, board, {0.01, 0.01, 0.002}));
    EXPECT_FALSE(solid(both, board, {0.01, 0.01, 0.018}));
    const std::vector<SurfacePatch> step{plane({0, 0, 0.015}, {0, 0, 1}),
                                         plane({0, 0, 0.005}, {0, 0, 1})};
    const Combination one =
        combine(std::vector{seen(0, {0.01, 0.01, 0.015}), seen(1, {0.03, 0.01, 0.005}, 0)}, step,
                middle, voxel);
    EXPECT_TRUE(solid(one, step, {0.01, 0.01, 0.01}));
    EXPECT_FALSE(solid(one, step, {0.01, 0.01, 0.017}));
}

TEST(Combine, WhatPassesByDecidesOrDropsOut) {
    const std::vector<SurfacePatch> patches{plane({0, 0, 0.05}, {0, 0, 1}),
                                            plane({0, 0, -0.05}, {0, 0, 1}),
                                            plane({0, 0, 0.01}, {0, 0, 1})};
    const Combination inside = combine(std::vector{seen(0, {0, 0, 0.05})}, patches, middle, voxel);
    EXPECT_EQ(inside.used, 0u);
    EXPECT_FALSE(inside.nothing);
    const Combination outside =
        combine(std::vector{seen(1, {0, 0, -0.05})}, patches, middle, voxel);
    EXPECT_TRUE(outside.nothing);
    EXPECT_EQ(combine({}, patches, middle, voxel).used, 0u);
}

TEST(Combine, ABoundHoldsForAll) {
    const std::vector<SurfacePatch> patches{plane({0, 0, 0.012}, {0, 0, 1}),
                                            plane({0.01, 0, 0}, {1, 0, 0})};
    Combination sum = combine(std::vector{seen(0, {0.01, 0.01, 0.012})}, patches, middle, voxel);
    add_bound(1, true, patches, middle, voxel, sum);
    EXPECT_EQ(sum.used, 2u);
    EXPECT_TRUE(solid(sum, patches, {0.015, 0.01, 0.005}));
    EXPECT_FALSE(solid(sum, patches, {0.005, 0.01, 0.005}));
    EXPECT_FALSE(solid(sum, patches, {0.015, 0.01, 0.015}));
    add_bound(1, true, patches, middle, voxel, sum);
    EXPECT_EQ(sum.used, 2u) << "the same again adds nothing";
}

}  // namespace
}  // namespace topple::solids
