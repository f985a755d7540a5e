// SPDX-License-Identifier: MIT
#include "export/shape.h"

#include "export/balance.h"
#include "export/touching.h"
#include "export/turned.h"
#include "export/visual.h"
#include "host/export/shapes_scene.h"
#include "io/palette.h"
#include "testing.h"

namespace topple::exports::test {
namespace {

TEST(Shape, APrismOfManySidesIsACylinderUprightOrNot) {
    for (const Vec3& axis : {Vec3{0, 0, 1}, Vec3{0.6, 0, 0.8}, Vec3{1, 0, 0}}) {
        const auto cylinder =
            std::get<Cylinder>(shape_of(*hull_part(prism({1, 2, 3}, axis, 0.04, 0.1, 32))));
        EXPECT_NEAR(cylinder.half_m, 0.1, 1e-9);
        EXPECT_NEAR(std::abs(dot(cylinder.axis, axis)), 1, 1e-9);
        EXPECT_NEAR(cylinder.center[0], 1, 1e-9);
        EXPECT_NEAR(cylinder.radius_m, 0.04, round_tolerance_m);
    }
}

// What it touches, or nearly so, is as far from it as from the part.
TEST(Shape, ACylinderReachesNoFurtherThanItsPart) {
    const ConvexPart part = *hull_part(prism({0, 0, 0.1}, {0, 0, 1}, 0.05, 0.1, 24));
    const auto cylinder = std::get<Cylinder>(shape_of(part));
    for (int n = 0; n < 360; ++n) {
        const double angle = n * std::numbers::pi / 180;
        const Vec3 direction{std::cos(angle), std::sin(angle), 0};
        EXPECT_NEAR(cylinder.radius_m, extent_along(part, direction).high, round_tolerance_m);
    }
    EXPECT_NEAR(cylinder.center[2] - cylinder.half_m, 0, 1e-9);
}

TEST(Shape, ABallIsASphere) {
    const auto sphere = std::get<Sphere>(shape_of(*hull_part(ball({1, 2, 3}, 0.03, 40))));
    EXPECT_NEAR(sphere.radius_m, 0.03, round_tolerance_m);
    EXPECT_NEAR(sphere.center[2], 3, 1e-4);
}

TEST(Shape, WhatIsCoarseLeansTapersOrIsAnEggIsNone) {
    std::vector<std::vector<Vec3>> all(4, prism({}, {0, 0, 1}, 0.04, 0.1, 32));
    all[0] = prism({}, {0, 0, 1}, 0.04, 0.1, 8);
    for (Vec3& p : all[1])
        if (p[2] > 0) p = {0.9 * p[0], 0.9 * p[1], p[2]};
    for (Vec3& p : all[2])
        if (p[2] > 0) p[2] += 0.1 * p[0];
    all[3] = ball({}, 0.03, 40);
    for (Vec3& p : all[3]) p[2] *= 1.1;
    for (const auto& points : all) EXPECT_TRUE(is_mesh(shape_of(*hull_part(points))));
}

TEST(Shape, ABoxAlongTheAxesIsNotTurned) {
    const Shape shape = shape_of(block({0, 0, 0}, {3, 1, 2}));
    ASSERT_TRUE(std::holds_alternative<Box>(shape));
    const Box& box = std::get<Box>(shape);
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(box.axis[a][a], 1, 1e-12);
    EXPECT_NEAR(box.half_m[0], 1.5, 1e-12);
    EXPECT_NEAR(box.half_m[1], 0.5, 1e-12);
    EXPECT_NEAR(box.half_m[2], 1, 1e-12);
}

// Turns about x, then y, then z, each about the fixed axis.
Axes turned_by(const Vec3& rpy) {
    Axes out{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    for (std::size_t about = 0; about < 3; ++about) {
        const double c = std::cos(rpy[about]), s = std::sin(rpy[about]);
        const std::size_t u = (about + 1) % 3, v = (about + 2) % 3;
        for (Vec3& axis : out) {
            const Vec3 was = axis;
            axis[u] = c * was[u] - s * was[v];
            axis[v] = s * was[u] + c * was[v];
        }
    }
    return out;
}

TEST(Turned, AnglesAndQuaternionsGiveTheAxesAgain) {
    constexpr double right = std::numbers::pi / 2;
    for (const Vec3& rpy : {Vec3{}, Vec3{0.3, 0.4, 0.5}, Vec3{3, -1.5, -2}, Vec3{0.2, right, 0.7},
                            Vec3{1, -right, 2}, Vec3{0, right - 1e-9, 1}}) {
        const Axes axes = turned_by(rpy);
        const Axes again = turned_by(roll_pitch_yaw(axes));
        const auto [w, x, y, z] = quaternion(axes);
        // Its first column.
        const Vec3 first{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)};
        for (std::size_t a = 0; a < 3; ++a) {
            EXPECT_NEAR(first[a], axes[0][a], 1e-12);
            for (std::size_t b = 0; b < 3; ++b) EXPECT_NEAR(again[a][b], axes[a][b], 1e-9);
        }
        EXPECT_GE(w, 0);
    }
}

// Of a block, as the scan's: turned by a right angle about z.
ObjectSurface surface_of(const Visual& block, std::int32_t object) {
    ObjectSurface out;
    out.object = object;
    const auto turned = [](const Vec3& v) { return Vec3{v[1], -v[0], v[2]}; };
    for (const Vec3& v : block.vertex) out.vertex.push_back(turned(v));
    for (const Vec3& n : block.normal) out.normal.push_back(turned(n));
    for (const Rgb8& c : block.colour) out.colour.emplace_back(c);
    out.triangle = block.triangle;
    return out;
}

class VisualOf : public ::testing::Test {
  protected:
    VisualOf() {
        sim.bodies = {body_of(block({1, 2, 0}, {2, 3, 1}), 1, {})};
        sim.bodies[0].object = 4;
        scene.manhattan_from_input = {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    }
    SimScene sim;
    Scene scene;
    const Visual painted = painted_block({1, 2, 0}, {2, 3, 1}, {10, 20, 30});
};

TEST_F(VisualOf, ABodyIsWhereTheBodyWasMovedTo) {
    sim.bodies[0].moved_m = {0, 0, -0.25};
    sim.bodies[0].center_m[2] -= 0.25;
    add_visuals(sim, scene, std::vector{surface_of(painted, 4)});
    const Visual& visual = sim.bodies[0].visual;
    ASSERT_EQ(visual.vertex.size(), 24u);
    EXPECT_EQ(visual.triangle, painted.triangle);
    const Vec3 center{1.5, 2.5, 0.5};
    for (std::size_t n = 0; n < 24; ++n) {
        for (std::size_t a = 0; a < 3; ++a) {
            EXPECT_NEAR(visual.vertex[n][a], painted.vertex[n][a] - center[a], 1e-12);
            EXPECT_NEAR(visual.normal[n][a], painted.normal[n][a], 1e-12);
        }
        EXPECT_EQ(visual.colour[n], (Rgb8{10, 20, 30}));
    }
}

TEST_F(VisualOf, WhatNobodySawTheColourOfHasItsObjects) {
    ObjectSurface surface = surface_of(painted, 4);
    surface.colour[0].reset();
    add_visuals(sim, scene, std::vector{surface});
    EXPECT_EQ(sim.bodies[0].visual.colour[0], io::colour_of(4));
    EXPECT_EQ(sim.bodies[0].visual.colour[1], (Rgb8{10, 20, 30}));
    surface.colour.clear();
    sim.bodies[0].fixed = true;
    add_visuals(sim, scene, std::vector{surface});
    EXPECT_EQ(sim.bodies[0].visual.colour[1], io::colour_of(-1));
}

TEST_F(VisualOf, AFlatSurfaceOrNoneLooksAsThePartsDo) {
    for (const bool flat : {true, false}) {
        std::vector<ObjectSurface> surfaces;
        if (flat) surfaces.push_back(surface_of(painted_block({}, {1, 1, 0}, {}), 4));
        add_visuals(sim, scene, surfaces);
        const Visual& visual = sim.bodies[0].visual;
        EXPECT_EQ(visual.triangle.size(), 12u);
        Vec3 low = visual.vertex.at(0);
        for (const Vec3& v : visual.vertex)
            for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], v[a]);
        for (const double each : low) EXPECT_NEAR(each, -0.5, 1e-12);
    }
}

}  // namespace
}  // namespace topple::exports::test

namespace topple::exports {
namespace {

constexpr double friction = 0.3, gravity = 9.81;

Body standing(ConvexPart part, int level, std::vector<std::int32_t> carried_by = {}) {
    Body out = test::body_of(std::move(part), level, std::move(carried_by));
    out.firm_m = 0.01;
    return out;
}
Body floor() {
    return test::body_of(test::block({-2, -2, -0.1}, {2, 2, 0}), 0, {});
}
// A board on two posts which are things of their own, the second at `post_x`; and a load at its
// end.
std::vector<Body> board_with_load(double post_x, double load_m) {
    std::vector<Body> out{floor()};
    out.push_back(standing(test::block({-0.5, -0.2, 0}, {-0.4, 0.2, 0.7}), 1));
    out.push_back(standing(test::block({post_x - 0.1, -0.2, 0}, {post_x, 0.2, 0.7}), 1));
    out.push_back(standing(test::block({-0.5, -0.2, 0.7}, {0.5, 0.2, 0.72}), 2, {1, 2}));
    out.push_back(standing(test::block({0.4, -0.1, 0.72}, {0.5, 0.1, 0.72 + load_m}), 3, {3}));
    return out;
}

// By body: free, on a pad, held.
std::string kept(std::vector<Body> bodies) {
    const std::size_t count = bodies.size();
    keep_balance(bodies, {friction, gravity});
    std::string out;
    for (std::size_t n = 0; n < count; ++n)
        out += bodies[n].held ? 'h' : bodies[n].on_pad ? 'p' : '.';
    return out;
}

TEST(Balance, WhatStandsIsLeftFree) {
    EXPECT_EQ(kept(board_with_load(0.5, 0.4)), ".....");
    std::vector<Body> stack{floor()};
    for (int n = 0; n < 10; ++n)
        stack.push_back(standing(test::block({0, 0, 0.1 * n}, {0.3, 0.3, 0.1 * (n + 1)}), n + 1));
    EXPECT_EQ(kept(stack), "...........");
}

TEST(Balance, WhatGoesOverWithItsLoadGetsAPadAndTheLoadDoesNot) {
    // Torques about the inner post's edge at x = 0.1: board 5.6 kg at 0, load 7 kg a litre at 0.45.
    const double balance_m = 5.6 * 0.1 / (0.35 * 14);  // height of the load that tips it: 0.114 m
    EXPECT_EQ(kept(board_with_load(0.1, 0.9 * balance_m)), ".....");
    EXPECT_EQ(kept(board_with_load(0.1, 1.1 * balance_m)), "...p.");
}

TEST(Balance, WhatFallsByItselfMayDoSo) {
    std::vector<Body> bodies = board_with_load(0.1, 0.4);
    bodies[3].firm_m = 0;
    // The load stands on it and goes down with it: only what is said to stand is held.
    EXPECT_EQ(kept(bodies), "....h");
}

// Four fifths of it, to be sure.
TEST(Balance, FrictionHoldsOnASlopeUpToItsAngle) {
    for (const double slope : {0.23, 0.27}) {
        // A wedge, fixed, and a slab on it.
        const double z = 2 * slope;
        std::vector<Body> bodies{
            test::body_of(*hull_part(std::vector<Vec3>{
                              {0, 0, 0}, {2, 0, 0}, {2, 0, z}, {0, 1, 0}, {2, 1, 0}, {2, 1, z}}),
                          0, {})};
        const double c = 1 / std::hypot(1, slope), s = slope * c;
        std::vector<Vec3> corners;
        for (unsigned n = 0; n < 8; ++n) {
            const double u = (n & 1) != 0 ? 1.2 : 0.9, w = (n & 4) != 0 ? 0.05 : 0;
            corners.push_back({u * c - w * s, (n & 2) != 0 ? 0.6 : 0.3, u * s + w * c});
        }
        bodies.push_back(standing(*hull_part(corners), 1));
        bodies[1].center_m = {1.05 * c - 0.025 * s, 0.45, 1.05 * s + 0.025 * c};
        EXPECT_EQ(kept(bodies), slope > 0.8 * friction ? ".h" : "..") << slope;
    }
}

TEST(Balance, WhatNothingCarriesGetsAPadOrIsHeld) {
    std::vector<Body> bodies{floor(), standing(test::block({0, 0, 0.2}, {0.3, 0.3, 0.5}), 1)};
    EXPECT_EQ(kept(bodies), ".p") << "in the air";
    // Its centre of mass lies beyond all of it.
    bodies[1].center_m[0] = 1;
    EXPECT_EQ(kept(bodies), ".h");
}

TEST(Touching, FacesEdgesAndCornersShareWhatLiesInBoth) {
    const ConvexPart low = test::block({0, 0, 0}, {1, 1, 1});
    const auto touch = touch_of(low, test::block({0.5, 0.25, 1}, {1.5, 0.75, 2}));
    EXPECT_NEAR(touch.normal[2], 1, 1e-9);
    ASSERT_EQ(touch.point.size(), 4u);
    double most = 0, least = 2;
    for (const Vec3& p : touch.point) {
        EXPECT_NEAR(p[2], 1, 1e-9);
        most = std::max(most, p[0]);
        least = std::min(least, p[0]);
    }
    EXPECT_NEAR(least, 0.5, 1e-9);
    EXPECT_NEAR(most, 1, 1e-9);
    const auto side = touch_of(low, test::block({1, 0.2, 0.2}, {2, 0.4, 0.4}));
    EXPECT_NEAR(side.normal[0], 1, 1e-9);
    EXPECT_EQ(side.point.size(), 4u);
    EXPECT_TRUE(touch_of(low, test::block({0, 0, 1.001}, {1, 1, 2})).point.empty());
    // A roof upside down stands on its ridge.
    const auto ridge = touch_of(
        low,
        *hull_part(std::vector<Vec3>{
            {0.2, 0.5, 1}, {0.8, 0.5, 1}, {0.2, 0, 2}, {0.8, 0, 2}, {0.2, 1, 2}, {0.8, 1, 2}}));
    EXPECT_GE(ridge.point.size(), 2u);
}

}  // namespace
}  // namespace topple::exports
