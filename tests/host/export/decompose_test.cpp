// SPDX-License-Identifier: MIT
#include "export/decompose.h"

#include <random>

#include "core/vectors.h"
#include "export/clumps.h"
#include "export/merge_parts.h"
#include "export/piece_solid.h"
#include "host/export/blocks.h"
#include "testing.h"

namespace topple::exports::test {
namespace {

std::vector<Decomposed> decomposed(const std::vector<Cells>& blocks, std::size_t primitives = 1) {
    ThreadPool threads(2);
    std::vector<Clump> clumps;
    for (std::size_t p = 0; p < primitives; ++p)
        clumps.push_back({0, {static_cast<std::int32_t>(p)}, 0});
    return decompose(solids_of(blocks, primitives), clumps, threads);
}

TEST(Decompose, ABoxIsOnePartOfItsVolume) {
    const Decomposed out = decomposed({{{0, 0, 0}, {20, 30, 5}}})[0];
    ASSERT_EQ(out.parts.size(), 1u);
    EXPECT_NEAR(out.solid_m3, 3e-3, 1e-12);
    EXPECT_NEAR(out.parts[0].volume_m3, 3e-3, 1e-9);
    EXPECT_NEAR(out.excess_m3, 0, 1e-9);
    EXPECT_TRUE(as_box(out.parts[0], 1e-6));
}

TEST(Decompose, AnAngleIsTwoBoxes) {
    const Decomposed out = decomposed({{{0, 0, 0}, {30, 10, 4}}, {{0, 0, 4}, {4, 10, 30}}})[0];
    EXPECT_EQ(out.parts.size(), 2u);
    EXPECT_NEAR(out.excess_m3, 0, 0.01 * out.solid_m3);
}

TEST(Decompose, AnOpenCupKeepsItsHollow) {
    std::vector<Cells> walls{{{0, 0, 0}, {20, 20, 2}},
                             {{0, 0, 2}, {2, 20, 20}},
                             {{18, 0, 2}, {20, 20, 20}},
                             {{2, 0, 2}, {18, 2, 20}},
                             {{2, 18, 2}, {18, 20, 20}}};
    const Decomposed out = decomposed(walls)[0];
    EXPECT_LE(out.excess_m3, 0.16 * out.solid_m3);
    EXPECT_LE(out.parts.size(), 10u);
    const Vec3 inside{0.1, 0.1, 0.12};
    for (const ConvexPart& part : out.parts) {
        bool holds = true;
        for (const HalfSpace& side : part.face)
            holds &= side.normal[0] * inside[0] + side.normal[1] * inside[1] +
                         side.normal[2] * inside[2] <=
                     side.offset_m;
        EXPECT_FALSE(holds);
    }
}

TEST(Decompose, OnlyWhatIsOfAClumpHasPartsAndAClumpIsOneSolid) {
    ThreadPool threads(1);
    const SolidScene solids = solids_of(
        {{{0, 0, 0}, {5, 5, 5}, 0}, {{6, 0, 0}, {9, 5, 5}, 1}, {{9, 0, 0}, {12, 5, 5}, 2}}, 3);
    const auto out = decompose(solids, std::vector<Clump>{{0, {1, 2}, 0}}, threads);
    ASSERT_EQ(out.size(), 1u);
    ASSERT_EQ(out[0].parts.size(), 1u);
    EXPECT_NEAR(out[0].parts[0].volume_m3, 6 * 5 * 5e-6, 1e-9);
}

// A floor of 40 x 40 x 4 voxels that ends half-way up its top layer, on which one side was seen
// fallen in; below, it was seen whole, from a cellar.
SolidScene floor_seen_from_both_sides(Role role) {
    const SolidScene whole = solids_of({{{0, 0, 0}, {40, 40, 4}}}, 1);
    BoundaryCells boundary;
    SurfacePatch top, underside;
    top.c = {-0.035, 0, 0, 1};  // z = 3.5 cm
    underside.c = {0.005, 0, 0, -1};
    boundary.patches = {underside, top};
    const std::uint32_t form = make_form(true, {SlotUse{false, true, false}}, 1);
    for (int i = 0; i < 40; ++i) {
        for (int j = 0; j < 40; ++j) {
            for (const int k : {0, 3}) {
                if (k == 3 && i < 10) continue;
                boundary.i.push_back(i);
                boundary.j.push_back(j);
                boundary.k.push_back(k);
                boundary.primitive.push_back(0);
                boundary.form.push_back(form);
                boundary.share.push_back(BoundaryCells::whole / 2);
                boundary.slot[0].push_back(k == 0 ? 0 : 1);
            }
        }
    }
    for (std::size_t s = 1; s < BoundaryCells::slots; ++s) boundary.slot[s].resize(boundary.size());
    for (auto& axis : boundary.moment) axis.resize(boundary.size());
    return {whole.cells(), {role}, {}, std::move(boundary)};
}

// Every second voxel is sampled here, and of all but those at the corners surfaces leave nothing.
TEST(PieceSolids, WhatIsSampledMayHaveNothingSolid) {
    const SolidScene whole = solids_of({{{0, 0, 0}, {5, 5, 5}}}, 1);
    BoundaryCells all;
    all.patches.resize(2);
    all.patches[0].c = {1};   // nothing is solid
    all.patches[1].c = {-1};  // all is
    const auto at_end = [](int n) { return n % 4 == 0; };
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 5; ++j) {
            for (int k = 0; k < 5; ++k) {
                all.i.push_back(i);
                all.j.push_back(j);
                all.k.push_back(k);
                all.primitive.push_back(0);
                all.form.push_back(make_form(true, {SlotUse{false, true, false}}, 1));
                all.slot[0].push_back(at_end(i) && at_end(j) && at_end(k) ? 1 : 0);
            }
        }
    }
    all.share.assign(all.size(), 1);
    for (std::size_t s = 1; s < BoundaryCells::slots; ++s) all.slot[s].resize(all.size());
    for (auto& axis : all.moment) axis.resize(all.size());
    std::vector<Cell> cells;
    std::vector<std::size_t> places;
    for (std::size_t n = 0; n < all.size(); ++n) {
        cells.push_back({{all.i[n], all.j[n], all.k[n]}, n});
        places.push_back(n);
    }
    CellGrid grid(std::move(cells));
    for (const std::size_t n : places) grid.mark(n, 0);
    const SolidScene solids(whole.cells(), {Role::none}, {}, std::move(all));
    const PieceSolid piece = PieceSolids(solids, grid).of(0, places);
    ASSERT_TRUE(piece.hull);
    EXPECT_TRUE(piece.hull->solid.empty());
    EXPECT_TRUE(std::isfinite(piece.hull->solid_each_m3));
}

TEST(Decompose, AFloorIsALevelSlabBelowItsTop) {
    ThreadPool threads(1);
    const SolidScene solids = floor_seen_from_both_sides(Role::floor);
    const auto out = decompose(solids, std::vector<Clump>{{0, {0}, 0, true}}, threads);
    ASSERT_TRUE(out[0].floor);
    ASSERT_EQ(out[0].parts.size(), 1u);
    EXPECT_NEAR(out[0].parts[0].high[2], 0.035, 1e-9);
    EXPECT_NEAR(out[0].parts[0].volume_m3, 0.4 * 0.4 * 0.05, 1e-6);
    // What can be moved is none.
    EXPECT_FALSE(decompose(solids, std::vector<Clump>{{0, {0}, 0, false}}, threads)[0].floor);
}

TEST(Clumps, CrumbsOfALargeObjectThatLieTogetherAreOne) {
    Scene scene;
    Object large;
    large.id = 0;
    for (int n = 0; n < 40; ++n) {
        Primitive p;
        p.id = n;
        p.object = 0;
        p.volume_m3 = n == 0 ? 1 : 1e-5;  // 10 voxels
        p.center_of_mass_m = {n < 20 ? 0.02 : 2.02, 0.02, 0.02};
        scene.primitives.push_back(p);
        large.primitives.push_back(n);
    }
    scene.objects.push_back(large);
    const auto clumps = clumps_of(scene, 0.01);
    ASSERT_EQ(clumps.size(), 3u);
    EXPECT_EQ(clumps[0].primitives.size(), 1u);
    EXPECT_EQ(clumps[1].primitives.size(), 19u);
    EXPECT_EQ(clumps[2].primitives.size(), 20u);
    scene.objects[0].primitives.resize(16);
    EXPECT_EQ(clumps_of(scene, 0.01).size(), 16u);
}

std::vector<Body> merged(std::vector<ConvexPart> parts, std::vector<ConvexPart> others) {
    std::vector<Body> bodies(2);
    bodies[0].parts = std::move(parts);
    for (const ConvexPart& part : bodies[0].parts) bodies[0].solid_m3 += part.volume_m3;
    bodies[1].parts = std::move(others);
    ThreadPool threads(1);
    merge_parts(bodies, 0.01, threads);
    return bodies;
}

TEST(MergeParts, JoinsWhatIsConvexTogetherAndNothingElse) {
    const auto out = merged({block({0, 0, 0}, {1, 1, 1}), block({1, 0, 0}, {2, 1, 1}),
                             block({5, 0, 0}, {6, 1, 1}), block({0, 0, 1}, {0.2, 1, 3})},
                            {});
    ASSERT_EQ(out[0].parts.size(), 3u);
    EXPECT_NEAR(out[0].parts.back().volume_m3, 2, 1e-9);
}

TEST(MergeParts, LeavesApartWhatOnlyAnotherBodyLiesBetween) {
    // Two blocks a step apart in height: their hull would hold the corner where another one stands.
    const std::vector<ConvexPart> steps{block({0, 0, 0}, {1, 1, 1}),
                                        block({1, 0, 0}, {2, 1, 1.05})};
    EXPECT_EQ(merged(steps, {})[0].parts.size(), 1u);
    EXPECT_EQ(merged(steps, {block({0.6, 0.4, 1}, {0.9, 0.6, 1.4})})[0].parts.size(), 2u);
}

TEST(ConvexPart, OfABoxHasItsVolumeFacesAndExtent) {
    const ConvexPart part = block({1, 2, 3}, {2, 4, 6});
    EXPECT_NEAR(part.volume_m3, 6, 1e-12);
    EXPECT_EQ(part.corner.size(), 8u);
    EXPECT_EQ(part.face.size(), 6u);
    const Interval along = extent_along(part, {0, 0, 1});
    EXPECT_EQ(along.low, 3);
    EXPECT_EQ(along.high, 6);
}

TEST(ConvexPart, CutsLeaveWhatIsInTheHalfSpace) {
    const ConvexPart part = block({0, 0, 0}, {1, 1, 1});
    const double s = std::sqrt(0.5);
    const auto half = cut(part, {{s, s, 0}, s});  // x + y <= 1
    ASSERT_TRUE(half);
    EXPECT_NEAR(half->volume_m3, 0.5, 1e-9);
    for (const Vec3& p : half->solid) EXPECT_LE(p[0] + p[1], 1 + 2 * on_plane_m);
    EXPECT_FALSE(cut(part, {{0, 0, 1}, -0.1}));
    EXPECT_EQ(cut(part, {{0, 0, 1}, 2})->volume_m3, part.volume_m3);
}

// Cut again and again, also through corners and along faces, as Qhull would have it.
TEST(ConvexPart, ManyCutsAreTheHullOfWhatTheyLeave) {
    std::mt19937 random(7);
    const auto number = [&] { return static_cast<double>(random()) / 4294967296.0 * 2 - 1; };
    for (int round = 0; round < 200; ++round) {
        ConvexPart part = block({-1, -1, -1}, {1, 1, 1});
        for (int n = 0; n < 12; ++n) {
            Vec3 normal = unit({number(), number(), number()});
            if (n % 3 == 1) normal = {0, n % 2 == 1 ? 1.0 : -1.0, 0};
            double offset = 0.4 + 0.5 * std::abs(number());
            if (n % 4 == 2) offset = dot(normal, part.corner[random() % part.corner.size()]);
            const auto left = cut(part, {normal, offset});
            if (!left) break;
            const auto hull = hull_part(left->corner);
            ASSERT_TRUE(hull);
            ASSERT_NEAR(left->volume_m3, hull->volume_m3, 1e-9);
            ASSERT_LE(extent_along(*left, normal).high, offset + 1e-7);
            part = *left;
        }
    }
}

TEST(ConvexPart, ShrinksOnAllSidesUnlessNothingIsLeft) {
    const ConvexPart part = block({0, 0, 0}, {1, 2, 3});
    EXPECT_NEAR(shrunk(part, 0.1).volume_m3, 0.8 * 1.8 * 2.8, 1e-9);
    EXPECT_EQ(shrunk(part, 0.6).volume_m3, part.volume_m3);
}

TEST(ConvexPart, WithoutVolumeIsNone) {
    EXPECT_FALSE(hull_part(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
    EXPECT_FALSE(hull_part(std::vector<Vec3>{}));
}

TEST(ConvexPart, ATurnedBoxIsOneAndAWedgeIsNot) {
    const double c = std::cos(0.4), s = std::sin(0.4);
    std::vector<Vec3> turned;
    for (const Vec3& v : block({-0.5, -1, -2}, {0.5, 1, 2}).corner)
        turned.push_back({c * v[0] - s * v[1] + 3, s * v[0] + c * v[1], v[2]});
    const auto box = as_box(*hull_part(turned), 1e-6);
    ASSERT_TRUE(box);
    EXPECT_NEAR(8 * box->half_m[0] * box->half_m[1] * box->half_m[2], 8, 1e-9);
    EXPECT_NEAR(box->center[0], 3, 1e-9);
    const auto wedge = cut(*hull_part(turned), {{0, 0.6, 0.8}, 0.5});
    EXPECT_FALSE(as_box(*wedge, 1e-3));
}

}  // namespace
}  // namespace topple::exports::test
