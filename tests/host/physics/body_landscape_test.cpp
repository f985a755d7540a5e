// SPDX-License-Identifier: MIT
#include "physics/body_landscape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/vectors.h"
#include "device/devices.h"
#include "host/physics/hulls.h"
#include "physics/sliding.h"

namespace topple::physics {
namespace {

constexpr std::array<double, 3> size{0.3, 0.2, 0.5};

std::vector<std::array<double, 2>> rectangle(double x0, double x1, double y0, double y1) {
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

struct Standing {
    const char* name;
    std::vector<std::array<double, 2>> support;
    double support_height_m;
    bool stood = true;
    std::vector<Vec3> more = {};  // of its hull
};

// The least climb out of the pose that it is in, by the disconnectivity graph.
double barrier_from_now(const Landscape& l) {
    const Landscape::Pose& now = l.poses.at(static_cast<std::size_t>(l.now));
    double least = now.joins_at_J;
    for (const Landscape::Pose& pose : l.poses)
        if (pose.joins == l.now) least = std::min(least, pose.joins_at_J);
    return least - now.energy_J;
}

// One hull for both: whatever holds it, the landscape's pose "now" is the one that was scanned, and
// its barrier that of the object.
TEST(BodyLandscape, NowIsThePoseAsScannedBehindItsBarrier) {
    const auto device = device::open_native(1);
    const Vec3 center{0, 0, size[2] / 2};
    const Standing ways[] = {
        {"on all of its foot", rectangle(-0.15, 0.15, -0.1, 0.1), 0},
        {"on a table's edge", rectangle(-0.15, 0.05, -0.1, 0.1), 0},
        {"on a narrow pedestal", rectangle(-0.002, 0.002, -0.1, 0.1), 0},
        {"something hangs down beside its support",
         rectangle(-0.15, 0.15, -0.1, 0.1),
         0,
         true,
         {{0.17, 0, -0.2}}},
        {"leans far over", rectangle(-0.15, 0.6, -0.1, 0.1), 0},
        {"stuck halfway in its support", rectangle(-0.15, 0.15, -0.1, 0.1), 0.1},
        {"hangs from its top", rectangle(-0.1, 0.1, -0.02, 0.02), 0.5},
        {"beside what it stands on", rectangle(0.05, 0.15, -0.1, 0.1), 0},
        {"nothing holds it", {}, 0, false}};
    for (const Standing& way : ways) {
        SCOPED_TRACE(way.name);
        std::vector<std::vector<Vec3>> vertices{test::box_hull(size[0], size[1], size[2]).points};
        for (Vec3& v : vertices[0]) v[2] += center[2];
        vertices[0].insert(vertices[0].end(), way.more.begin(), way.more.end());
        const SupportTable table(*device, vertices, 0.01, geodesic_sphere(8));
        Candidate box;
        box.primitives = {0};
        box.body.mass_kg = 20;
        box.body.center = center;
        box.support_polygon = way.support;
        box.support_height_m = way.support_height_m;
        box.stood = way.stood;
        const Stability tipping =
            evaluate(*device, table, std::span(&box, 1), Passes::exact).front();
        const Landscape l = body_landscape(table, box, tipping.ways);
        const Landscape::Pose& now = l.poses.at(static_cast<std::size_t>(l.now));
        EXPECT_EQ(now.up, (Vec3{0, 0, 1}));
        EXPECT_EQ(now.energy_J, 0);
        EXPECT_NEAR(barrier_from_now(l), combine_curves(tipping, {}).barrier_J,
                    1e-6 * box.body.mass_kg * gravity);
        EXPECT_TRUE(std::ranges::is_sorted(l.poses, {}, &Landscape::Pose::energy_J));
        EXPECT_TRUE(std::ranges::is_sorted(l.passes, {}, &Landscape::Pass::energy_J));
        std::size_t deepest = 0;
        for (const Landscape::Pose& pose : l.poses) {
            deepest += pose.joins < 0;
            EXPECT_GE(pose.joins_at_J, pose.energy_J);
            if (pose.joins < 0) continue;
            EXPECT_LE(l.poses.at(static_cast<std::size_t>(pose.joins)).energy_J, pose.energy_J);
        }
        EXPECT_EQ(deepest, 1U);
    }
}

TEST(BodyLandscape, AFlatSheetHasThePoseAsScannedAlone) {
    const auto device = device::open_native(1);
    const SupportTable table(*device,
                             std::vector<std::vector<Vec3>>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                             0.01, geodesic_sphere(8));
    Candidate sheet;
    sheet.primitives = {0};
    sheet.body.mass_kg = 1;
    sheet.body.center = {0.3, 0.3, 0};
    const Landscape l = body_landscape(table, sheet, {});
    EXPECT_TRUE(l.hull_m.empty());
    ASSERT_EQ(l.poses.size(), 1U);
    EXPECT_EQ(l.now, 0);
    EXPECT_EQ(l.poses[0].up, (Vec3{0, 0, 1}));
}

}  // namespace
}  // namespace topple::physics
