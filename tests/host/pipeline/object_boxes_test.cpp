// SPDX-License-Identifier: MIT
#include "objects/object_boxes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "device/devices.h"
#include "host/solids/boxes.h"
#include "solids/boundary.h"

namespace topple {
namespace {

// Two boxes that follow the grid and stand anywhere on it, of which all sides were seen.
TEST(ObjectBoxes, reach_from_surface_to_surface) {
    constexpr double voxel = 0.02;
    const auto device = device::open_native();
    for (const double shift : {0.0, 0.0037, 0.0113}) {
        SCOPED_TRACE(shift);
        const std::vector<solids::Box> boxes{{{0.31 + shift, -0.2, 0.5}, {0.05, 0.08, 0.12}},
                                             {{0.8, -0.2 + shift, 0.5}, {0.03, 0.05, 0.04}}};
        const solids::Scanned scanned = solids::scan(boxes, voxel);
        BoundaryCells boundary = solids::find_boundary(*device, scanned.cells, scanned.seen(),
                                                       scanned.patches, {false, false});
        const std::vector<std::int32_t> own{0, 1}, one{0, 0};
        const SolidScene solids(scanned.cells, {Role::none, Role::none}, {}, boundary);
        const std::vector<ObjectBox> found = object_boxes(solids, own, 2);
        for (std::size_t o = 0; o < 2; ++o) {
            for (std::size_t a = 0; a < 3; ++a) {
                const auto axis = static_cast<int>(a);
                EXPECT_NEAR(found[o].size_m[a], 2 * boxes[o].half[axis], 1e-4)
                    << "box " << o << ", axis " << a;
                EXPECT_NEAR(found[o].middle_m[a], boxes[o].middle[axis], 1e-4)
                    << "box " << o << ", axis " << a;
            }
            EXPECT_NEAR(found[o].top_m(), boxes[o].middle[2] + boxes[o].half[2], 1e-4);
        }
        const ObjectBox both = object_boxes(solids, one, 1)[0];
        EXPECT_NEAR(both.size_m[0], 0.8 + 0.03 - (0.31 + shift - 0.05), 1e-4);
        EXPECT_NEAR(both.middle_m[0], (0.8 + 0.03 + 0.31 + shift - 0.05) / 2, 1e-4);
        // Where nothing is known within voxels they count whole.
        const SolidScene coarse(scanned.cells, {Role::none, Role::none});
        const Vec3 whole = object_boxes(coarse, own, 2)[0].size_m;
        for (std::size_t a = 0; a < 3; ++a) {
            EXPECT_GE(whole[a], 2 * boxes[0].half[static_cast<int>(a)]);
            EXPECT_LE(whole[a], 2 * boxes[0].half[static_cast<int>(a)] + 2.01 * voxel);
        }
        const ObjectBox nothing = object_boxes(solids, own, 3)[2];  // an object without voxels
        EXPECT_EQ(nothing.size_m, Vec3{});
        EXPECT_TRUE(std::isnan(nothing.middle_m[0]));
    }
}

}  // namespace
}  // namespace topple
