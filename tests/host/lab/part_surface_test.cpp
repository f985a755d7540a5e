// SPDX-License-Identifier: MIT
#include "lab/solids/part_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/random.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

struct Solid {
    const char* name;
    Part part;
    double area;  // closed form
};

Part turned(Part part) {
    part.yaw = 0.7;
    if (part.shape != Shape::lying_cylinder) part.lean = 0.4;
    return part;
}

// One solid of each shape, turned and away from the origin.
std::vector<Solid> solids_of_all_shapes() {
    const Vec3 at{1, -2, 0.5};
    Part rounded{Shape::rounded_box, at, {0.5, 0.3, 0.2}, 0, 0, 0, ""};
    rounded.rounding = 0.05;
    const double core = 0.4 * 0.2 + 0.2 * 0.1 + 0.1 * 0.4;
    Part bowl{Shape::revolved, at, {0.4, 0.4, 0.2}, 0, 0, 0, ""};
    bowl.profile = {{0, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {0.15, 0.1}, {0.15, 0}, {0, 0}};
    const double slant = std::hypot(0.1, 0.4);
    return {
        {"box", turned({Shape::box, at, {0.5, 0.3, 0.2}, 0, 0, 0, ""}),
         2 * (0.5 * 0.3 + 0.3 * 0.2 + 0.2 * 0.5)},
        {"rounded", turned(rounded),
         2 * core + 2 * pi * 0.05 * (0.4 + 0.2 + 0.1) + 4 * pi * 0.05 * 0.05},
        {"cylinder", turned({Shape::cylinder, at, {0.2, 0.2, 0.6}, 0, 0, 0, ""}),
         pi * 0.2 * 0.6 + 2 * pi * 0.01},
        {"lying", turned({Shape::lying_cylinder, at, {0.6, 0.2, 0.2}, 0, 0, 0, ""}),
         pi * 0.2 * 0.6 + 2 * pi * 0.01},
        {"sphere", turned({Shape::sphere, at, {0.3, 0.3, 0.3}, 0, 0, 0, ""}), pi * 0.09},
        {"cone", turned({Shape::cone, at, {0.4, 0.4, 0.4}, 0, 0.5, 0, ""}),
         pi * (0.04 + 0.01 + 0.3 * slant)},
        {"revolved", turned(bowl), 2 * pi * (0.2 * 0.2 + 0.15 * 0.1) + pi * (2 * 0.04)},
    };
}

TEST(PartSurface, PatchesMakeUpTheSurface) {
    for (const Solid& solid : solids_of_all_shapes()) {
        std::vector<Sheet> sheets;
        add_sheets(solid.part, 0, sheets);
        std::vector<Patch> patches;
        for (std::size_t k = 0; k < sheets.size(); ++k)
            add_patches(sheets[k], static_cast<std::uint32_t>(k), 0.025, patches);
        double sum = 0, quarters = 0;
        for (const Patch& patch : patches) {
            sum += patch.area(sheets[patch.sheet]);
            for (const Patch& quarter : patch.quarters())
                quarters += quarter.area(sheets[patch.sheet]);
        }
        EXPECT_NEAR(sum, solid.area, 1e-9) << solid.name;
        EXPECT_NEAR(quarters, solid.area, 1e-9) << solid.name;
    }
}

TEST(PartSurface, PointsLieOnTheSolidWithItsNormal) {
    Random random(1);
    for (const Solid& solid : solids_of_all_shapes()) {
        std::vector<Sheet> sheets;
        add_sheets(solid.part, 0, sheets);
        std::vector<Patch> patches;
        for (std::size_t k = 0; k < sheets.size(); ++k)
            add_patches(sheets[k], static_cast<std::uint32_t>(k), 0.025, patches);
        for (const Patch& patch : patches) {
            const Sheet& sheet = sheets[patch.sheet];
            const auto [p, n] = patch.spread(sheet, random(0.01, 0.99), random(0.01, 0.99));
            ASSERT_NEAR(solid.part.distance(p), 0, 1e-9) << solid.name;
            const Vec3 out{p[0] + 1e-4 * n[0], p[1] + 1e-4 * n[1], p[2] + 1e-4 * n[2]};
            ASSERT_NEAR(solid.part.distance(out), 1e-4, 1e-7) << solid.name;
            const auto corner = sheet.at(patch.u[0], patch.v[0]).point;
            ASSERT_LT(std::hypot(p[0] - corner[0], p[1] - corner[1], p[2] - corner[2]), 0.036)
                << solid.name;
        }
    }
}

// Half of the points of a disc's patches are beyond the radius that halves their area.
TEST(PartSurface, PointsAreSpreadEvenlyOverADisc) {
    std::vector<Sheet> sheets;
    add_sheets({Shape::cone, {}, {2, 2, 0.5}, 0, 0, 0, ""}, 0, sheets);
    const Patch whole{0, sheets[0].u, sheets[0].v};
    Random random(2);
    int beyond = 0;
    constexpr int count = 40000;
    for (int k = 0; k < count; ++k) {
        const Vec3 p = whole.spread(sheets[0], random.uniform(), random.uniform()).point;
        if (std::hypot(p[0], p[1]) > std::sqrt(0.5)) ++beyond;
    }
    EXPECT_NEAR(beyond, count / 2, 500);  // five standard deviations
}

}  // namespace
}  // namespace topple::scenes
