// SPDX-License-Identifier: MIT
#include "export/fronts.h"

#include <Eigen/Dense>

#include "core/vectors.h"
#include "export/joints.h"
#include "export/named_bodies.h"
#include "host/export/blocks.h"
#include "lab/random.h"

namespace topple::exports::test {
namespace {

Grip knob(double u, double z) {
    return {Grip::Form::knob, u, z, 0.03, 0.03, 0.03, 0.95};
}
Grip bar(double u, double z) {
    return {Grip::Form::level_bar, u, z, 0.15, 0.02, 0.035, 0.95};
}
GrippedFace face(double wide_m, double high_m, std::vector<Grip> grips) {
    GrippedFace out;
    out.out = {0, 1, 0};
    out.across = {-1, 0, 0};
    out.high_u = wide_m;
    out.high_z = high_m;
    out.deep_m = 0.5;
    out.grips = std::move(grips);
    return out;
}

TEST(ColumnsOfFronts, KnobsSideBySideAreOfTwoDoorsThatOpenFromTheMiddle) {
    const auto columns = columns_of(face(0.8, 0.75, {knob(0.35, 0.4), knob(0.45, 0.4)}));
    ASSERT_EQ(columns.size(), 2u);
    EXPECT_GT(columns[0].hinge_at_low_u, 0.95);
    EXPECT_GT(columns[1].hinge_at_high_u, 0.95);
    EXPECT_NEAR(columns[0].low_u, 0, 0.01);
    EXPECT_NEAR(columns[0].high_u, 0.4, 0.02);
    EXPECT_NEAR(columns[1].high_u, 0.8, 0.01);
}

TEST(ColumnsOfFronts, GripsOverOneAnotherAreOfDrawers) {
    const auto columns =
        columns_of(face(0.6, 0.9, {bar(0.3, 0.18), bar(0.31, 0.48), bar(0.29, 0.78)}));
    ASSERT_EQ(columns.size(), 1u);
    EXPECT_GT(columns[0].slide, 0.9);
    EXPECT_NEAR(columns[0].low_u, 0, 0.01);
    EXPECT_NEAR(columns[0].high_u, 0.6, 0.01);
    ASSERT_EQ(columns[0].grips.size(), 3u);
    EXPECT_LT(columns[0].grips[0].z, columns[0].grips[2].z);
}

// Which way a door in a row opens is told by where its neighbours end: three doors of which each
// opens at its low edge, and drawers behind them.
TEST(ColumnsOfFronts, NeighboursTellWhichWayADoorOpens) {
    const auto columns = columns_of(
        face(1.95, 0.85,
             {knob(0.05, 0.4), knob(0.55, 0.4), knob(1.0, 0.4), bar(1.66, 0.25), bar(1.66, 0.67)}));
    ASSERT_EQ(columns.size(), 4u);
    for (std::size_t n = 0; n < 3; ++n) EXPECT_GT(columns[n].hinge_at_high_u, 0.8) << n;
    EXPECT_GT(columns[3].slide, 0.9);
    EXPECT_NEAR(columns[1].low_u, 0.5, 0.02);
    EXPECT_NEAR(columns[2].low_u, 0.95, 0.02);
    EXPECT_NEAR(columns[3].low_u, 1.37, 0.03);
}

// A cabinet against a wall, seen from the front: its front with grips, its top and sides.
class SeenCabinet {
  public:
    explicit SeenCabinet(double deep_m = 0.5, double noise_m = 0.001) : noise_m_(noise_m) {
        scene_.objects.resize(2);
        for (std::int32_t n = 0; n < 2; ++n) scene_.objects[n].id = n;
        scene_.manhattan_from_input = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        sheet({0, 0, 0}, {0.8, 0, 0}, {0, 0, 0.7}, {0, -1, 0}, 1);  // looks to -y
        if (deep_m > 0) {
            sheet({0, 0, 0.7}, {0.8, 0, 0}, {0, deep_m, 0}, {0, 0, 1}, 1);
            sheet({0, 0, 0}, {0, deep_m, 0}, {0, 0, 0.7}, {-1, 0, 0}, 1);
        }
        sheet({-1, deep_m, 0}, {3, 0, 0}, {0, 0, 2.4}, {0, -1, 0}, 0);
    }
    void add_bar(double x, double z, double wide, double high, double out_m = 0.036) {
        sheet({x - wide / 2, -out_m, z - high / 2}, {wide, 0, 0}, {0, 0, high}, {0, -1, 0}, 1);
    }
    Scene& scene() { return scene_; }

  private:
    void sheet(const Vec3& from, const Vec3& u, const Vec3& v, const Vec3& normal,
               std::int32_t object) {
        constexpr double spacing = 0.008;
        const auto count = [&](const Vec3& side) {
            return static_cast<int>(length(side) / spacing) + 1;
        };
        ScenePoints& p = scene_.points;
        for (int a = 0; a <= count(u); ++a)
            for (int b = 0; b <= count(v); ++b) {
                const Vec3 at =
                    along(along(along(from, a / (count(u) + 0.0), u), b / (count(v) + 0.0), v),
                          noise_m_ * random_(-1.0, 1.0), normal);
                p.x.push_back(static_cast<float>(at[0]));
                p.y.push_back(static_cast<float>(at[1]));
                p.z.push_back(static_cast<float>(at[2]));
                p.nx.push_back(static_cast<float>(normal[0]));
                p.ny.push_back(static_cast<float>(normal[1]));
                p.nz.push_back(static_cast<float>(normal[2]));
                p.object.push_back(object);
            }
    }

    double noise_m_;
    scenes::Random random_{1};
    Scene scene_;
};

TEST(Fronts, ACabinetsDoorsAreFoundByTheirHandles) {
    SeenCabinet cabinet;
    for (const double x : {0.35, 0.45}) cabinet.add_bar(x, 0.35, 0.012, 0.15);
    const auto fronts = fronts_of(cabinet.scene());
    EXPECT_TRUE(fronts[0].empty());
    ASSERT_EQ(fronts[1].size(), 2u);
    for (const Front& front : fronts[1]) {
        EXPECT_NEAR(front.out[1], -1, 1e-3);
        EXPECT_NEAR(front.middle[1], 0, 0.005);
        EXPECT_NEAR(front.wide_m, 0.4, 0.03);
        EXPECT_NEAR(front.high_m, 0.7, 0.03);
        EXPECT_NEAR(front.deep_m, 0.5, 0.1);
        // The hinge is at the outer edge, far from the handle.
        const double to_low = front.opening == Opening::hinge_at_low_u ? -1 : 1;
        const double hinge = front.middle[0] + to_low * front.across[0] * front.wide_m / 2;
        EXPECT_NEAR(std::abs(hinge - front.grip[0]), 0.35, 0.04);
    }
}

TEST(Fronts, AWideBarAlongTheUpperEdgeIsAFlaps) {
    SeenCabinet cabinet;
    cabinet.add_bar(0.4, 0.6, 0.5, 0.02);
    const auto fronts = fronts_of(cabinet.scene());
    ASSERT_EQ(fronts[1].size(), 1u);
    EXPECT_EQ(fronts[1][0].opening, Opening::hinge_below);
}

TEST(Fronts, WallsThingsBeforeAFrontAndNoiseHaveNone) {
    SeenCabinet wall(0);  // with nothing behind it
    wall.add_bar(0.4, 0.4, 0.15, 0.02);
    SeenCabinet before;  // what reaches on is no handle
    before.add_bar(0.4, 0.4, 0.15, 0.02);
    before.add_bar(0.4, 0.4, 0.15, 0.02, 0.12);
    SeenCabinet thick;
    thick.add_bar(0.4, 0.4, 0.2, 0.12);
    SeenCabinet noisy(0.5, 0.03);
    SeenCabinet without;
    for (SeenCabinet* each : {&wall, &before, &thick, &noisy, &without})
        for (const auto& fronts : fronts_of(each->scene())) EXPECT_TRUE(fronts.empty());
    SeenCabinet no_points;
    no_points.scene().points = {};
    for (const auto& fronts : fronts_of(no_points.scene())) EXPECT_TRUE(fronts.empty());
}

Front drawer_of_a_cabinet() {
    Front drawer;
    drawer.out = {0, -1, 0};
    drawer.across = {1, 0, 0};
    drawer.middle = {0.4, 0, 0.5};
    drawer.wide_m = 0.78;
    drawer.high_m = 0.3;
    drawer.deep_m = 0.5;
    drawer.grip = {0.4, -0.015, 0.5};
    drawer.grip_m = {0.15, 0.03, 0.02};
    return drawer;
}

// Mass, centre and inertia about one point of a body and its fronts together.
TEST(JointedFronts, WeighWithTheirBodyWhatItWeighed) {
    std::vector<Body> bodies{body_of(block({0, 0, 0}, {0.8, 0.5, 0.7}), 1, {})};
    const double m = bodies[0].mass_kg;
    bodies[0].inertia_kg_m2 = {m * 0.06, 0.1, 0, 0.1, m * 0.09, 0, 0, 0, m * 0.07};
    const Body whole = bodies[0];
    const Front drawer = drawer_of_a_cabinet();
    Front door = drawer;
    door.opening = Opening::hinge_at_high_u;
    door.middle[2] = door.grip[2] = 0.2;
    const auto fronts = fronts_on_joints(bodies, {{drawer, door}}, 700);
    ASSERT_EQ(fronts.size(), 2u);
    EXPECT_EQ(fronts[0].boxes.size(), 6u);
    EXPECT_EQ(fronts[1].boxes.size(), 2u);
    const auto vec = [](const Vec3& v) { return Eigen::Vector3d(v[0], v[1], v[2]); };
    const auto about_origin = [&](double mass, const Vec3& center, const Mat3& inertia) {
        const Eigen::Vector3d d = vec(center);
        return (Eigen::Matrix3d(inertia.data()) +
                mass * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose()))
            .eval();
    };
    double mass = bodies[0].mass_kg;
    Eigen::Vector3d moment = mass * vec(bodies[0].center_m);
    Eigen::Matrix3d inertia = about_origin(mass, bodies[0].center_m, bodies[0].inertia_kg_m2);
    for (const JointedFront& front : fronts) {
        mass += front.mass_kg;
        moment += front.mass_kg * vec(front.center_m);
        inertia += about_origin(front.mass_kg, front.center_m, front.inertia_kg_m2);
        double volume = 0;
        for (const Box& box : front.boxes)
            volume += 8 * box.half_m[0] * box.half_m[1] * box.half_m[2];
        EXPECT_NEAR(front.mass_kg, 700 * volume, 1e-9);
    }
    EXPECT_NEAR(mass, whole.mass_kg, 1e-9);
    EXPECT_LT((moment / mass - vec(whole.center_m)).norm(), 1e-12);
    EXPECT_LT((inertia - about_origin(whole.mass_kg, whole.center_m, whole.inertia_kg_m2)).norm(),
              1e-9);
    EXPECT_EQ(fronts[0].axis, drawer.out);
    EXPECT_EQ(fronts[1].axis, (Vec3{0, 0, 1}));
    EXPECT_NEAR(fronts[1].at_m[0], 0.79, 1e-12);
}

TEST(JointedFronts, WhatIsTooLightForThemHasNone) {
    std::vector<Body> bodies{body_of(block({0, 0, 0}, {0.8, 0.5, 0.7}), 1, {})};
    bodies[0].mass_kg = 5;
    Front door;
    door.opening = Opening::hinge_at_low_u;
    door.out = {0, -1, 0};
    door.across = {1, 0, 0};
    door.middle = {0.4, 0, 0.35};
    door.wide_m = 0.8;
    door.high_m = 0.7;
    EXPECT_TRUE(fronts_on_joints(bodies, {{door}}, 700).empty());
    EXPECT_EQ(bodies[0].mass_kg, 5);
}

// A wall beside a cabinet, whose hull reaches into the drawer's board; its solid does so, or not.
TEST(JointedFronts, HullsThatBulgeIntoAFrontGiveWay) {
    const Front drawer = drawer_of_a_cabinet();
    for (const bool bulges : {true, false}) {
        std::vector<Body> bodies{body_of(block({0, 0, 0}, {0.8, 0.5, 0.7}), 1, {}),
                                 body_of(block({-0.5, -0.2, 0}, {0.1, 0.5, 1}), 0, {})};
        ConvexPart& wall = bodies[1].parts[0];
        bodies[1].solid_m3 = wall.volume_m3;
        if (bulges) std::erase_if(wall.solid, [](const Vec3& p) { return p[0] > 0; });
        const auto fronts = fronts_on_joints(bodies, {{drawer}}, 700);
        EXPECT_NEAR(bodies[1].parts[0].high[0], bulges ? 0.012 : 0.1, 1e-9);
        EXPECT_EQ(fronts.size(), bulges ? 1u : 0u);
    }
}

TEST(JointedFronts, AHandleThatWasFoundAsAThingIsPartOfItsFront) {
    const Front drawer = drawer_of_a_cabinet();
    std::vector<Body> bodies{body_of(block({0, 0, 0}, {0.8, 0.5, 0.7}), 1, {}),
                             body_of(block({0.33, -0.035, 0.485}, {0.47, 0.005, 0.515}), 2, {0}),
                             body_of(block({0.33, -0.5, 0.485}, {0.47, -0.005, 0.515}), 2, {0})};
    ASSERT_EQ(fronts_on_joints(bodies, {{drawer}}, 700).size(), 1u);
    EXPECT_TRUE(bodies[1].parts.empty());
    EXPECT_FALSE(bodies[2].parts.empty());
}

// Before anything is cut back, or taken from a handle.
TEST(JointedFronts, WhatTheirBodyCannotSpareTouchesNothing) {
    const Front drawer = drawer_of_a_cabinet();
    std::vector<Body> bodies{body_of(block({0, 0, 0}, {0.8, 0.5, 0.7}), 1, {}),
                             body_of(block({0.33, -0.035, 0.485}, {0.47, 0.005, 0.515}), 2, {0}),
                             body_of(block({-0.5, -0.2, 0}, {0.1, 0.5, 1}), 0, {})};
    bodies[0].mass_kg = 5;
    bodies[2].solid_m3 = bodies[2].parts[0].volume_m3;
    std::erase_if(bodies[2].parts[0].solid, [](const Vec3& p) { return p[0] > 0; });
    EXPECT_TRUE(place_fronts(bodies, {{drawer}}, 700).empty());
    EXPECT_EQ(bodies[1].parts.size(), 1u);
    EXPECT_NEAR(bodies[2].parts[0].high[0], 0.1, 1e-9);
}

TEST(JointedFronts, WhereAFootIsInTheWayTheHandleIsPartOfTheFurniture) {
    std::vector<Body> bodies{body_of(block({0, 0, 0}, {0.8, 0.5, 0.7}), 1, {}),
                             body_of(block({0.33, -0.035, 0.485}, {0.47, 0.005, 0.515}), 2, {0})};
    std::vector<JointedFront> fronts = place_fronts(bodies, {{drawer_of_a_cabinet()}}, 700);
    ASSERT_EQ(fronts.size(), 1u);
    EXPECT_TRUE(bodies[1].parts.empty());
    const double mass_kg = bodies[0].mass_kg;
    bodies.push_back(body_of(block({0.2, -0.02, 0}, {0.25, 0.3, 0.5}), 1, {}));
    joint_fronts(fronts, bodies);
    EXPECT_TRUE(fronts.empty());
    EXPECT_EQ(bodies[0].parts.size(), 2u);
    EXPECT_EQ(bodies[0].mass_kg, mass_kg);
}

}  // namespace
}  // namespace topple::exports::test
