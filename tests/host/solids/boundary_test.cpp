// SPDX-License-Identifier: MIT
#include "solids/boundary.h"

#include "device/devices.h"
#include "host/solids/boxes.h"
#include "physics/bodies.h"
#include "physics/part_hulls.h"
#include "physics/qhull.h"
#include "physics/tipping.h"
#include "solids/cell_shape.h"
#include "testing.h"
#include "topple/error.h"

namespace topple::solids {
namespace {

constexpr double density = 1;  // a body's mass is its volume

struct Bounded {
    Scanned scanned;
    BoundaryCells boundary;
    std::vector<physics::MassProperties> bodies;
};

Bounded bounded(const std::vector<Box>& boxes, double voxel_m) {
    const auto device = device::open_native();
    Bounded out{scan(boxes, voxel_m), {}, {}};
    const std::vector<bool> sheet(boxes.size(), false);
    out.boundary =
        find_boundary(*device, out.scanned.cells, out.scanned.seen(), out.scanned.patches, sheet);
    const std::vector<double> densities(boxes.size(), density);
    out.bodies =
        physics::mass_properties(*device, out.scanned.cells,
                                 static_cast<std::int32_t>(boxes.size()), densities, out.boundary);
    return out;
}

// Of a box of which all sides were seen, wherever it lies and however it is turned.
TEST(Boundary, AnAskewBoxHasItsVolumeCentreAndHullAtAnyVoxelSize) {
    const Eigen::Vector3d half(0.05, 0.08, 0.12);
    for (const double voxel : {0.01, 0.02, 0.04}) {
        for (int turn = 0; turn < 6; ++turn) {
            SCOPED_TRACE(testing::Message() << voxel << " m, turn " << turn);
            const Box box{{0.31 + 0.0037 * turn, -0.2, 0.5 + 0.003 * turn},
                          half,
                          turned(0.3 * turn, 0.1 * turn, -0.07 * turn)};
            const Bounded b = bounded({box}, voxel);
            EXPECT_NEAR(b.bodies[0].volume_m3 / box.volume(), 1, 0.004 * voxel / 0.02);
            for (int a = 0; a < 3; ++a)
                EXPECT_NEAR(b.bodies[0].center[a], box.middle[a], 0.02 * voxel);
            ThreadPool threads(2);
            const auto points =
                physics::part_hulls(b.scanned.cells, b.boundary, {true}, threads).corners[0];
            double inside = 0;
            for (const Vec3& p : points) {
                EXPECT_TRUE(box.holds({p[0], p[1], p[2]}, 1e-5)) << p[0] << " " << p[1];
                inside = std::max(inside, (Eigen::Vector3d(p[0], p[1], p[2]) - box.middle).norm());
            }
            EXPECT_NEAR(inside, half.norm(), 1e-4) << "the corners are there";
        }
    }
}

// As of a cup: one side of a wall is one primitive's, the other another's.
TEST(Boundary, AWallThinnerThanAVoxelIsAsThickAsItsTwoSidesSay) {
    for (const double thick : {0.004, 0.008, 0.015}) {
        for (int turn = 0; turn < 4; ++turn) {
            SCOPED_TRACE(testing::Message() << thick << " m, turn " << turn);
            Box outside{{0.31 + 0.0037 * turn, -0.2, 0.5},
                        {thick / 2, 0.12, 0.1},
                        turned(0.2 * turn, 0.03 * turn, 0)};
            Box inside = outside;
            inside.seen = 2;  // +x
            outside.seen = 63 & ~inside.seen;
            const Bounded b = bounded({outside, inside}, 0.02);
            EXPECT_NEAR((b.bodies[0].volume_m3 + b.bodies[1].volume_m3) / outside.volume(), 1,
                        0.08);
        }
    }
}

// A cup of three primitives: its outside, its inside, and the bottom within it. Its voxels are as
// wide as what its wall bends around.
TEST(Boundary, ACupIsItsWallAndItsBottom) {
    constexpr double outer = 0.04, inner = 0.035, height = 0.09, thick = 0.005, spacing = 0.004;
    constexpr double pi = std::numbers::pi;
    for (int place = 0; place < 4; ++place) {
        SCOPED_TRACE(place);
        const Eigen::Vector3d foot(0.3 + 0.0047 * place, -0.2 + 0.0061 * place, 0.5);
        Scanned s;
        s.cells.voxel_m = 0.02;
        const auto add = [&](double r, double angle, double z, std::int32_t primitive,
                             std::int32_t patch) {
            test::add(s.cloud, foot.x() + r * std::cos(angle), foot.y() + r * std::sin(angle),
                      foot.z() + z);
            s.primitive.push_back(primitive);
            s.patch.push_back(patch);
        };
        const auto around = [&](double r, double z, std::int32_t primitive, std::int32_t patch) {
            const int steps = static_cast<int>(std::ceil(2 * pi * r / spacing));
            for (int n = 0; n < steps; ++n) add(r, 2 * pi * n / steps, z, primitive, patch);
        };
        for (double z = spacing / 2; z < height; z += spacing) {
            around(outer, z, 0, 0);
            if (z > thick) around(inner, z, 1, 1);
        }
        for (double r = spacing / 2; r < inner; r += spacing) around(r, thick, 2, 2);
        around((outer + inner) / 2, height, 0, 3);
        around((outer + inner) / 2, height, 1, 4);
        // And what it stands on.
        for (double r = outer; r < 0.09; r += spacing) around(r, 0, 3, 5);
        const auto tube = [&](double r, double sign) {
            SurfacePatch out = plane(foot, {0, 0, 0});
            out.c = {-sign * r / 2, 0, 0, 0, sign / (2 * r), sign / (2 * r), 0, 0, 0, 0};
            return out;
        };
        const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
        s.patches = {tube(outer, 1),
                     tube(inner, -1),
                     plane(foot + thick * up, up),
                     plane(foot + height * up, up),
                     plane(foot + height * up, up),
                     plane(foot, up)};
        std::map<std::array<std::int32_t, 3>, std::int32_t> cells;
        const auto index = [&](double v) {
            return static_cast<std::int32_t>(std::floor(v / s.cells.voxel_m));
        };
        for (std::size_t n = 0; n < s.cloud.size(); ++n)
            cells.try_emplace(
                {index(s.cloud.x[n]), index(s.cloud.y[n]), index(s.cloud.z[n] - 1e-6)},
                s.primitive[n]);
        for (const auto& [at, primitive] : cells) s.cells.add(at, primitive, Basis::surface);
        const auto device = device::open_native();
        const BoundaryCells boundary =
            find_boundary(*device, s.cells, s.seen(), s.patches, std::vector<bool>(4, false));
        const std::vector<physics::MassProperties> bodies = physics::mass_properties(
            *device, s.cells, 4, std::vector<double>(4, density), boundary);
        const double wall = pi * (outer * outer - inner * inner) * height,
                     bottom = pi * inner * inner * thick;
        const double volume = bodies[0].volume_m3 + bodies[1].volume_m3 + bodies[2].volume_m3;
        EXPECT_NEAR(volume / (wall + bottom), 1, 0.03);
        double z = 0;
        for (std::size_t n = 0; n < 3; ++n) z += bodies[n].volume_m3 * bodies[n].center[2];
        EXPECT_NEAR(z / volume - foot.z(),
                    (wall * height / 2 + bottom * thick / 2) / (wall + bottom), 0.001);
    }
}

// Nobody saw where the upper one's underside is, nor the lower one's top under it.
TEST(Boundary, WhatStandsOnAnotherEndsWhereThatBegins) {
    for (const double height : {0.100, 0.1049, 0.11, 0.1163}) {
        SCOPED_TRACE(height);
        const Eigen::Matrix3d yaw = turned(0.4, 0, 0);
        const Box below{{0, 0, height / 2}, {0.3, 0.25, height / 2}, yaw},
            above{{0.02, 0.03, height + 0.06}, {0.05, 0.07, 0.06}, turned(0.7, 0, 0), 0b101111};
        const Bounded b = bounded({below, above}, 0.02);
        EXPECT_NEAR(b.bodies[1].volume_m3 / above.volume(), 1, 0.006);
        EXPECT_NEAR(b.bodies[1].center[2], height + 0.06, 2e-4);
        EXPECT_NEAR(b.bodies[0].volume_m3 / below.volume(), 1, 0.006);
        // They share no volume and leave none.
        EXPECT_NEAR(b.bodies[0].volume_m3 + b.bodies[1].volume_m3, below.volume() + above.volume(),
                    0.004 * below.volume());
    }
}

// The true shape is an L: its inner edge is concave.
TEST(Boundary, AConcaveEdgeIsNoWiderThanItsFaces) {
    const Box foot{{0.1, 0.05, 0.0325}, {0.1, 0.05, 0.0325}},
        post{{0.03, 0.05, 0.12}, {0.03, 0.05, 0.12}};
    // One primitive: points within the other are none.
    Scanned both = scan({foot, post}, 0.02), one;
    one.patches = both.patches;
    one.cells = both.cells;
    std::fill(one.cells.primitive.begin(), one.cells.primitive.end(), 0);
    for (std::size_t n = 0; n < both.cloud.size(); ++n) {
        const Eigen::Vector3d p(both.cloud.x[n], both.cloud.y[n], both.cloud.z[n]);
        if ((both.primitive[n] == 0 ? post : foot).holds(p, -1e-6)) continue;
        test::add(one.cloud, both.cloud.x[n], both.cloud.y[n], both.cloud.z[n]);
        one.primitive.push_back(0);
        // Faces that are flush are one.
        constexpr std::array<std::int32_t, 12> of_one{0, 1, 2, 3, 4, 5, 0, 7, 2, 3, 10, 11};
        one.patch.push_back(of_one[both.patch[n]]);
    }
    const auto device = device::open_native();
    const BoundaryCells b =
        find_boundary(*device, one.cells, one.seen(), one.patches, std::vector<bool>(1, false));
    const double volume = 0.2 * 0.1 * 0.065 + 0.06 * 0.1 * (0.24 - 0.065);
    EXPECT_NEAR(
        physics::mass_properties(*device, one.cells, 1, std::vector{density}, b)[0].volume_m3 /
            volume,
        1, 0.01);
}

// What ends within its lowest voxels has the outline of its faces there.
TEST(CellShape, TheUndersideHasTheBoxesOwnOutline) {
    const Box box{{0.013, 0.027, 0.083}, {0.06, 0.04, 0.08}, turned(0.5, 0, 0)};
    const Bounded b = bounded({box}, 0.02);
    std::vector<std::array<double, 2>> points;
    std::array<std::int32_t, 2> last{INT32_MIN, INT32_MIN};
    const SolidCells& c = b.scanned.cells;
    for (std::size_t n = 0; n < c.size(); ++n) {  // the first of a column is its lowest
        if (last == std::array{c.i[n], c.j[n]}) continue;
        last = {c.i[n], c.j[n]};
        for (const UndersideCorner& u : underside_of(b.boundary, c.i[n], c.j[n], c.k[n], 0, 0.02)) {
            EXPECT_NEAR(u.at[2], 0.003, 0.0025);
            points.push_back({u.at[0], u.at[1]});
        }
    }
    const auto outline = physics::convex_polygon(points);
    double area = 0;
    for (std::size_t n = 0; n < outline.size(); ++n) {
        const auto &p = outline[n], &q = outline[(n + 1) % outline.size()];
        area += (p[0] * q[1] - p[1] * q[0]) / 2;
    }
    EXPECT_NEAR(area / (4 * 0.06 * 0.04), 1, 0.002);
}

// What carries a voxel need not pass within it: a hair below, the voxel's lowest side is the
// underside.
TEST(CellShape, TheUndersideIsThereWhereverThePatchBelowPasses) {
    const double h = 0.01;
    for (const double below : {-0.3, -0.02, -0.003, -0.0005, 0.0, 0.0005, 0.003, 0.02, 0.3}) {
        BoundaryCells b;
        SurfacePatch floor;
        floor.origin = {0, 0, below * h};
        floor.c[3] = 1;
        b.patches = {floor};
        for (auto* index : {&b.i, &b.j, &b.k, &b.primitive}) *index = {0};
        for (auto& slot : b.slot) slot = {0};
        for (auto& moment : b.moment) moment = {0};
        b.form = {make_form(false, {SlotUse{true, false, true}}, 1)};
        b.share = {BoundaryCells::whole};
        const auto corners = underside_of(b, 0, 0, 1, 0, h);
        std::set<std::pair<double, double>> places;  // a corner of the voxel may be told twice
        for (const UndersideCorner& u : corners) {
            EXPECT_NEAR(u.at[2], std::max(below, 0.0) * h, 1.1e-3 * h) << below;
            EXPECT_TRUE(u.bounded);
            places.insert({u.at[0], u.at[1]});
        }
        EXPECT_EQ(places.size(), 4u) << below;
    }
}

// Two cells each of three primitives: of the first surfaces leave nothing, of the second something
// in one cell, and of the third they say nothing in one.
TEST(Boundary, WhatSurfacesLeaveNothingOfIsSolidAsWholeVoxels) {
    SolidCells cells;
    BoundaryCells all;
    for (std::int32_t i = 0; i < 6; ++i) {
        cells.add({i, 0, 0}, i / 2, Basis::surface);
        if (i == 5) continue;
        all.i.push_back(i);
        all.j.push_back(0);
        all.k.push_back(0);
        all.primitive.push_back(i / 2);
        for (auto& slot : all.slot) slot.push_back(0);
        all.form.push_back(0);
        all.share.push_back(i == 3 ? 7 : 0);
        for (auto& moment : all.moment) moment.push_back(0);
    }
    const BoundaryCells kept = without_void_solids(cells, all, 3);
    EXPECT_EQ(kept.i, (std::vector<std::int32_t>{2, 3, 4}));
    EXPECT_EQ(kept.primitive, (std::vector<std::int32_t>{1, 1, 2}));
}

TEST(Boundary, NothingSeenBoundsNothing) {
    Scanned s = scan({{{0, 0, 0}, {0.05, 0.05, 0.05}}}, 0.02);
    s.cloud = {};
    s.primitive.clear();
    s.patch.clear();
    const auto device = device::open_native();
    EXPECT_EQ(find_boundary(*device, s.cells, s.seen(), {}, {false}).size(), 0u);
    EXPECT_EQ(find_boundary(*device, {}, {}, {}, {}).size(), 0u);
    EXPECT_EQ(form_error_m({}, 0.02), 0.02);
}

TEST(Boundary, IsTheSameOnAllBackends) {
    const Scanned s = scan({{{0.1, 0.2, 0.3}, {0.1, 0.07, 0.12}, turned(0.3, 0.2, 0.1)}}, 0.02);
    const BoundaryCells want =
        find_boundary(*device::open_native(), s.cells, s.seen(), s.patches, {false});
    for (const char* name : {"opencl", "vulkan"}) {
        std::shared_ptr<device::Device> device;
        try {
            device = device::open_device(name);
        } catch (const Error&) {
            continue;
        }
        const BoundaryCells got = find_boundary(*device, s.cells, s.seen(), s.patches, {false});
        EXPECT_EQ(got.share, want.share) << name;
        EXPECT_EQ(got.moment, want.moment) << name;
    }
}

}  // namespace
}  // namespace topple::solids
