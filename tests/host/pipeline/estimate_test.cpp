// SPDX-License-Identifier: MIT
#include "scale/estimate.h"

#include <cmath>

#include "host/pipeline/scan.h"
#include "points/parse_memory.h"
#include "points/scan_look.h"

namespace topple::test {
namespace {

class Estimates : public Files {
  protected:
    Estimate of(const Scan& scan, const char* name) const {
        scenes::write_sequence(path(name), scan.world, scan.sequence);
        return estimate(path(name), on(device::open_device("native")));
    }
};

TEST_F(Estimates, readings_that_one_frame_shows_are_no_space) {
    Scan scan = scan_of_room(3, 6);
    const Estimate clean = of(scan, "clean");
    const auto far = static_cast<std::uint16_t>(60 * scan.sequence.intrinsics.depth_scale);
    // Every third pixel is looked at.
    for (std::size_t n = 0; n < 3; ++n) scan.sequence.frames[2].depth[30 * n + 3] = far;
    const Estimate stray = of(scan, "stray");
    EXPECT_LT(static_cast<double>(stray.memory_bytes),
              1.05 * static_cast<double>(clean.memory_bytes));
    EXPECT_LT(static_cast<double>(stray.least_bytes),
              1.05 * static_cast<double>(clean.least_bytes));
}

TEST(ParseMemory, grows_with_points_and_with_the_surfaces_voxels) {
    const Bounds<float> room{{0, 0, 0}, {5, 4, 3}};
    const auto asked = [&](double points, double voxel_m) {
        return static_cast<double>(one_piece_bytes(points, 80, room, voxel_m));
    };
    EXPECT_GT(asked(1e5, 0.01), 2.5 * asked(1e5, 0.02));
    EXPECT_GT(asked(4e6, 0.02), 2 * asked(1e5, 0.02));
    const OnePiece parse{1e5, 80 / (0.02 * 0.02), 60 / (0.02 * 0.02 * 0.02), 20, 50, true};
    EXPECT_GT(asked(1e5, 0.02), 1.4 * one_piece_peak(parse));
}

// A level square of 4 m with a box of 0.5 m on it, turned by `degrees` about an upright axis.
PointCloud box_on_floor(double degrees, bool box) {
    const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
    PointCloud out;
    const auto add = [&](double x, double y, double z) {
        out.x.push_back(static_cast<float>(c * x - s * y));
        out.y.push_back(static_cast<float>(s * x + c * y));
        out.z.push_back(static_cast<float>(z));
    };
    const auto each = [](double edge, const auto& use) {
        for (double u = 0.01; u < edge; u += 0.02)
            for (double v = 0.01; v < edge; v += 0.02) use(u, v);
    };
    each(4, [&](double u, double v) { add(u - 2, v - 2, 0); });
    if (!box) return out;
    each(0.5, [&](double u, double v) {
        add(u, v, 0.5);
        for (const double side : {0.0, 0.5}) {
            add(side, u, v);
            add(u, side, v);
        }
    });
    return out;
}

TEST(ScanLook, spans_the_scene_along_its_own_axes) {
    const auto device = device::open_device("native");
    for (const double degrees : {0.0, 30.0}) {
        const ScanLook look = look_at_scan(*device, box_on_floor(degrees, true), 0.02, 17, {});
        EXPECT_NEAR(look.box.ground_m2, 16, 0.5) << degrees;
        EXPECT_NEAR(look.box.m3(), 8, 0.5) << degrees;
    }
}

TEST(ScanLook, counts_what_stands_there) {
    const auto device = device::open_device("native");
    const double floor = look_at_scan(*device, box_on_floor(0, false), 0.02, 16, {}).patches_m,
                 both = look_at_scan(*device, box_on_floor(0, true), 0.02, 17, {}).patches_m;
    EXPECT_NEAR(floor, 4, 0.5);
    EXPECT_NEAR(both, 4 + 5 * 0.5, 1);
}

}  // namespace
}  // namespace topple::test
