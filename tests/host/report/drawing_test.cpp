// SPDX-License-Identifier: MIT
#include "report/drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "synthetic_scene.h"

namespace topple::report {
namespace {

// A box of 0.3 x 0.2 x 0.5 m, 1 kg, upright, that slides off its support at 2 J. Poses and passes
// are its closed forms, on 9.80665 m/s^2.
Scene scene_of_a_box() {
    Scene scene;
    scene.manhattan_from_input = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    Object object;
    object.id = 0;
    object.mass_kg = 1;
    object.mode = "slide";
    object.instability = {{2, 7}, {3, 9}};
    object.why.W_J = 2;
    object.why.S_J = 7;
    object.why.drop_m = 0.7;
    Landscape& l = object.landscape;
    for (const double x : {-0.15, 0.15}) {
        for (const double y : {-0.1, 0.1}) {
            for (const double z : {-0.25, 0.25}) l.hull_m.push_back({x, y, z});
        }
    }
    const auto joules = [](double height_m) { return 9.80665 * (height_m - 0.25); };
    const double inf = std::numeric_limits<double>::infinity();
    const double over_15_10 = joules(std::hypot(0.15, 0.1)),
                 over_25_10 = joules(std::hypot(0.25, 0.1));
    l.poses = {{{0, 1, 0}, joules(0.1), inf, -1, 0.3},
               {{0, -1, 0}, joules(0.1), over_15_10, 0, 0.3},
               {{1, 0, 0}, joules(0.15), over_15_10, 0, 0.15},
               {{-1, 0, 0}, joules(0.15), over_15_10, 0, 0.15},
               {{0, 0, 1}, 0, over_25_10, 0, 0.05},
               {{0, 0, -1}, 0, over_25_10, 0, 0.05}};
    const double side = 0.25 / std::hypot(0.25, 0.1), top = 0.1 / std::hypot(0.25, 0.1);
    l.passes = {{{0, top, side}, over_25_10, {4, 0}, {{0.1, 0.2, 0.97}, {0, top, side}}}};
    l.now = 4;
    l.places = {3,
                0.1,
                {0, 1, 2, std::numeric_limits<float>::quiet_NaN(), 0, 1, -7, -7,
                 std::numeric_limits<float>::infinity()}};
    scene.objects = {object};
    return scene;
}

const Drawing& titled(const std::vector<Drawing>& all, const std::string& start) {
    return *std::ranges::find_if(all, [&](const Drawing& d) { return d.title.starts_with(start); });
}

TEST(SphereMap, KeepsAreasAndTurnsBack) {
    EXPECT_EQ(map_of({0, 0, 1}), (Point{0, 0}));
    // Leaning east is up going west, and is drawn to the right; north is at the top.
    const Point east = map_of({-0.6, 0, 0.8}), north = map_of({0, -0.6, 0.8});
    EXPECT_GT(east[0], 0.2);
    EXPECT_NEAR(east[1], 0, 1e-12);
    EXPECT_LT(north[1], -0.2);
    // A cap of half the sphere takes half the disc.
    const Point equator = map_of({1, 0, 0});
    EXPECT_NEAR(equator[0] * equator[0] + equator[1] * equator[1], 0.5, 1e-12);
    EXPECT_NEAR(std::hypot(map_of({0, 0, -1})[0], map_of({0, 0, -1})[1]), 1, 1e-12);
    for (const Vec3& d : {Vec3{0.6, 0, 0.8}, Vec3{0, -0.8, -0.6}, Vec3{0.48, 0.64, 0.6}}) {
        const Vec3 back = direction_at(map_of(d));
        for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(back[a], d[a], 1e-12);
    }
}

TEST(Drawings, ShowPosesTreePlacesAndCurve) {
    const Scene scene = scene_of_a_box();
    const std::vector<Drawing> all = landscape_drawings(scene, scene.objects[0]);
    ASSERT_EQ(all.size(), 4u);
    for (const Drawing& d : all) {
        for (const Drawing::Stroke& stroke : d.strokes) {
            for (const Point& p : stroke.points) {
                EXPECT_TRUE(p[0] >= 0 && p[0] <= d.width && p[1] >= 0 && p[1] <= d.height)
                    << d.title;
            }
        }
        for (const Drawing::Dot& dot : d.dots)
            EXPECT_TRUE(dot.at[0] >= 0 && dot.at[0] <= d.width && dot.at[1] <= d.height) << d.title;
    }
    const Drawing& poses = titled(all, "Poses");
    ASSERT_TRUE(poses.sphere);
    EXPECT_EQ(poses.sphere->corners.size(), 8u);
    EXPECT_NEAR(poses.sphere->lowest_m, 0.1, 1e-12);
    EXPECT_NEAR(poses.sphere->highest_m, std::hypot(0.15, 0.1, 0.25), 1e-12);
    const auto count = [](const Drawing& d, Drawing::Style style) {
        return std::ranges::count(d.dots, style, &Drawing::Dot::style);
    };
    EXPECT_EQ(count(poses, Drawing::Style::pose), 5);
    EXPECT_EQ(count(poses, Drawing::Style::now), 1);
    EXPECT_EQ(count(poses, Drawing::Style::lowest), 1) << "the pass that is its barrier";
    const auto now = std::ranges::find(poses.dots, Drawing::Style::now, &Drawing::Dot::style);
    EXPECT_EQ(now->at, poses.sphere->middle);

    const Drawing& tree = titled(all, "Disconnectivity");
    EXPECT_EQ(count(tree, Drawing::Style::pose), 6) << "five other poses and the fall";
    EXPECT_TRUE(
        std::ranges::any_of(tree.labels, [](const auto& l) { return l.text == "fallen: -7 J"; }));
    // Deeper leaves are drawn lower: the fall, to -7 J, lowest of all.
    const auto lowest =
        std::ranges::max_element(tree.dots, {}, [](const auto& d) { return d.at[1]; });
    for (const Drawing::Dot& dot : tree.dots)
        EXPECT_EQ(dot.at[1] == lowest->at[1], &dot == &*lowest);

    const Drawing& places = titled(all, "Places");
    ASSERT_TRUE(places.raster);
    const auto& code = places.raster->code;
    ASSERT_EQ(code.size(), 9u);
    // Rows from above, that is from the north: the last of the input's comes first.
    EXPECT_EQ(code[0], code[1]);
    EXPECT_NE(code[0], code[2]) << "a fall is no wall";
    EXPECT_NE(code[3], code[4]) << "what is unknown is not 0 J";
    EXPECT_EQ(code[4], code[6]) << "0 J both";
    EXPECT_LT(code[7], code[8]) << "more work";
    for (const std::uint8_t c : code) EXPECT_LT(c, places.raster->palette.size());
    EXPECT_TRUE(titled(all, "Instability").labels.size() >= 4);
}

TEST(Drawings, OfWhatIsNotKnownAreLeftOut) {
    Scene scene = scene_of_a_box();
    Object& object = scene.objects[0];
    object.landscape = {};
    EXPECT_EQ(landscape_drawings(scene, object).size(), 1u);
    object.instability.clear();
    EXPECT_TRUE(landscape_drawings(scene, object).empty());
    object = scene_of_a_box().objects[0];
    object.grounded = true;
    EXPECT_TRUE(landscape_drawings(scene, object).empty());
}

// A body with ever so many poses: the deepest are drawn, and what it is in.
TEST(Drawings, OfManyPosesShowTheDeepest) {
    Scene scene = scene_of_a_box();
    Landscape& l = scene.objects[0].landscape;
    const double inf = std::numeric_limits<double>::infinity();
    l.poses.clear();
    l.passes.clear();
    for (int n = 0; n < 60; ++n) {
        const double angle = 2 * std::numbers::pi * n / 60;
        l.poses.push_back({{std::cos(angle), std::sin(angle), 0},
                           0.1 * n,
                           n == 0 ? inf : 6 + 0.01 * n,
                           n == 0 ? -1 : n / 2,
                           1.0 / 60});
    }
    l.now = 59;
    const std::vector<Drawing> all = landscape_drawings(scene, scene.objects[0]);
    const Drawing& poses = titled(all, "Poses");
    EXPECT_EQ(poses.dots.size(), 10u);
    EXPECT_EQ(std::ranges::count(poses.dots, Drawing::Style::now, &Drawing::Dot::style), 1);
}

}  // namespace
}  // namespace topple::report
