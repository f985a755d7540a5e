// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>
#include <vector>

#include "host/api/c_api.h"
#include "topple/stages.h"

namespace topple::test {
namespace {

TEST_F(CApi, StagesAreThoseOfTheLibrary) {
    const std::size_t n = room.cloud.size();
    double spacing = 0;
    ASSERT_EQ(topple_point_spacing(&cloud, &spacing, &status), TOPPLE_OK);
    std::vector<float> nx(n), ny(n), nz(n), ex(n), ey(n), ez(n);
    ASSERT_EQ(
        topple_normals(device, &cloud, 0.04, nullptr, nx.data(), ny.data(), nz.data(), &status),
        TOPPLE_OK);
    const auto own = device::open_device("native");
    stages::normals(*own, room.cloud, 0.04, nullptr, ex, ey, ez);
    const auto refused = [&](topple_device* with, double cell_m) {
        EXPECT_EQ(
            topple_normals(with, &cloud, cell_m, nullptr, nx.data(), ny.data(), nz.data(), &status),
            TOPPLE_ERROR_USAGE);
        return std::string(status.message);
    };
    const auto given = nx;
    EXPECT_TRUE(refused(device, 0).starts_with("normals: cell_m 0: expected metres"));
    EXPECT_TRUE(refused(nullptr, 0.04).starts_with("device is NULL; "));
    EXPECT_EQ(nx, given);
    EXPECT_EQ(nz, ez);
    EXPECT_EQ(spacing, stages::point_spacing(room.cloud));

    const double corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, center[] = {.25, .25, .25};
    const std::uint64_t first[] = {0, 4};
    const double mass = 2;
    double barrier = 0, release = -1;
    ASSERT_EQ(topple_barriers(device, corners, first, 1, &mass, center, 0.001, &barrier, &release,
                              &status),
              TOPPLE_OK);
    EXPECT_NEAR(barrier, 2 * 9.80665 * (std::hypot(0.25, 0.25) - 0.25), 1e-6);

    float vertices[] = {1, 2, 3}, directions[] = {1, 0, 0}, s[] = {9, 9};
    const topple_array v{vertices, 3, 0, 0}, d{directions, 1, 0, 0}, zero{directions + 1, 1, 0, 0};
    const topple_array vs[] = {v, v, v}, ds[] = {d, zero, zero}, out{s, 2, 0, 0};
    const std::uint64_t sets[] = {0, 1, 3};
    ASSERT_EQ(topple_support_functions(device, vs, sets, 2, ds, &out, &status), TOPPLE_OK)
        << status.message;
    EXPECT_EQ(s[0], 1.0f);
    EXPECT_EQ(s[1], 2.0f);

    float primary[] = {1, 2, 3, 4}, density[4];
    const topple_array p{primary, 4, 0, 0}, q{density, 4, 0, 0};
    const topple_footprint_entry ahead{1, 0, 10};
    const std::uint32_t entries[] = {0, 1};
    ASSERT_EQ(topple_convolve(device, 4, 1, 1, 0, &p, &ahead, entries, &q, &status), TOPPLE_OK)
        << status.message;
    EXPECT_EQ(std::vector<float>(density, density + 4), (std::vector<float>{20, 30, 40, 0}));
    EXPECT_EQ(topple_convolve(device, 5, 1, 1, 0, &p, &ahead, entries, &q, &status),
              TOPPLE_ERROR_USAGE);

    topple_volume* volume = nullptr;
    const std::vector<std::int32_t> label(n, 0);
    ASSERT_EQ(topple_volume_create(&cloud, label.data(), 0.03, &volume, &status), TOPPLE_OK);
    EXPECT_EQ(topple_volume_state(volume, 10, 10, 0), 1);
    const topple_intrinsics camera{2, 2, 1, 1, 0.5, 0.5, 1000};
    const std::uint16_t depth[] = {1000, 1000, 1000, 1000};
    const double pose[] = {1, 0, 0, 1.4, 0, -1, 0, 0.4, 0, 0, -1, 1, 0, 0, 0, 1};
    EXPECT_EQ(topple_volume_carve(volume, device, &camera, depth, pose, 1, &status), TOPPLE_OK)
        << status.message;
    EXPECT_EQ(topple_volume_state(volume, 46, 13, 10), 0);
    std::uint64_t filled = 0;
    EXPECT_EQ(topple_volume_fill(volume, device, 2, nullptr, 0, &filled, &status), TOPPLE_OK);
    EXPECT_GT(filled, 0u);
    topple_volume_release(volume);
}

}  // namespace
}  // namespace topple::test
