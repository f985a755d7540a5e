// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "points/scale_checks.h"

namespace topple {
namespace {

// Corners and middles of a box.
PointCloud box(double x, double y, double z) {
    PointCloud out;
    for (int n = 0; n < 27; ++n) {
        out.x.push_back(static_cast<float>(x * (n % 3) / 2));
        out.y.push_back(static_cast<float>(y * (n / 3 % 3) / 2));
        out.z.push_back(static_cast<float>(z * (n / 9) / 2));
    }
    return out;
}

// Rooms and small parts in other units than metres are told before the work; those in metres, and
// buildings as dense as scans are, are not.
TEST(UnitHint, by_size_and_spacing) {
    const struct {
        const char* what;
        Vec3 size;
        double spacing;
        ScanOrigin origin;
        const char* hint;  // null: none
    } cases[] = {
        {"a cube of 20 mm",
         {20, 20, 20},
         INFINITY,
         ScanOrigin::mesh_file,
         "unit_m = 0.001 (0.020 m)"},
        {"a room in mm",
         {4000, 3000, 2500},
         INFINITY,
         ScanOrigin::mesh_file,
         "unit_m = 0.001 (4.0 m)"},
        {"in cm", {400, 300, 250}, INFINITY, ScanOrigin::mesh_file, "unit_m = 0.01 (4.0 m)"},
        {"in inches", {157, 118, 98}, 0.2, ScanOrigin::cloud_file, "unit_m = 0.0254 (4.0 m)"},
        {"in feet", {13, 10, 8.2}, 0.03, ScanOrigin::cloud_file, "unit_m = 0.3048 (4.0 m)"},
        {"in memory", {13, 10, 8.2}, 0.03, ScanOrigin::cloud_in_memory, "by 0.3048 (4.0 m)"},
        {"a room", {4, 3, 2.5}, INFINITY, ScanOrigin::mesh_file, nullptr},
        {"a hall", {25, 20, 4.5}, 0.03, ScanOrigin::cloud_file, nullptr},
        {"a building", {60, 40, 12}, 0.01, ScanOrigin::cloud_file, nullptr},
        {"a map", {60, 40, 12}, 0.05, ScanOrigin::map_file, nullptr},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.what);
        const PointCloud cloud = box(c.size[0], c.size[1], c.size[2]);
        const std::string hint = unit_hint(cloud, c.spacing, c.origin);
        if (c.hint)
            EXPECT_NE(hint.find(c.hint), std::string::npos) << hint;
        else
            EXPECT_EQ(hint, "");
    }
}

}  // namespace
}  // namespace topple
