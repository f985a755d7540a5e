// SPDX-License-Identifier: MIT
#include "export/visual.h"

#include <gtest/gtest.h>

#include "host/export/shapes_scene.h"
#include "io/palette.h"

namespace topple::exports::test {
namespace {

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
