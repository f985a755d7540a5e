// SPDX-License-Identifier: MIT
#include "pipeline/estimate.h"

#include "host/pipeline/scan.h"
#include "pipeline/parse_memory.h"

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
    const auto peak = [&](double points, double voxel_m) {
        return one_piece_peak(points, 80, room, voxel_m);
    };
    EXPECT_GT(peak(1e5, 0.01), 2.5 * peak(1e5, 0.02));
    EXPECT_EQ(peak(1e4, 0.02), peak(1e5, 0.02)) << "the surface's voxels decide";
    EXPECT_GT(peak(4e6, 0.02), 3 * peak(1e5, 0.02));
    EXPECT_GT(static_cast<double>(one_piece_bytes(1e5, 80, room, 0.02)), 1.4 * peak(1e5, 0.02));
}

}  // namespace
}  // namespace topple::test
