// SPDX-License-Identifier: MIT
#include "clouds.h"
#include "core/depth_noise.h"
#include "points/frames_fusion.h"
#include "points/frames_witnesses.h"
#include "testing.h"
#include "topple/error.h"
#include "topple/kernel_testing/random.h"

namespace topple::geometry {
namespace {

constexpr Intrinsics camera{160, 120, 140, 140, 79.5, 59.5, 1000};

// A wall at 3 m with a box's face at 1.5 m before it, with the sensor's noise.
DepthFrame view(std::uint64_t seed, double shift) {
    test::Random random(seed);
    DepthFrame frame;
    frame.camera_to_world[3] = shift;
    for (std::uint32_t v = 0; v < camera.height; ++v) {
        for (std::uint32_t u = 0; u < camera.width; ++u) {
            const double x = (u - camera.cx) / camera.fx * 1.5 + shift;
            const double z = std::abs(x) < 0.2 ? 1.5 : 3.0;
            frame.depth.push_back(static_cast<std::uint16_t>(
                std::lround(1000 * (z + depth_sigma(z) * random.normal()))));
        }
    }
    return frame;
}

TEST(Fusion, WallBecomesThinAndStraysGo) {
    FrameFusion fusion(camera, 0.01);
    for (int i = 0; i < 12; ++i) {
        DepthFrame frame = view(static_cast<std::uint64_t>(i), 0.02 * i - 0.12);
        frame.depth[60 * 160 + 20] = 1200;  // flying
        fusion.add(frame);
    }
    const FusedCloud fused = fusion.finish();
    ASSERT_EQ(fused.viewpoints.size(), 12u);
    ASSERT_EQ(fused.viewpoint_of_point.size(), fused.cloud.size());
    std::vector<double> off;
    for (std::size_t i = 0; i < fused.cloud.size(); ++i) {
        EXPECT_LT(fused.viewpoint_of_point[i], 12u);
        const double z = fused.cloud.z[i];
        off.push_back(std::min(std::abs(z - 3), std::abs(z - 1.5)));
    }
    std::sort(off.begin(), off.end());
    ASSERT_GT(off.size(), 20'000u);
    EXPECT_LT(off[off.size() / 2], 0.003);  // sigma of one reading: 14 mm
    EXPECT_LT(off[off.size() * 95 / 100], 0.01);
    EXPECT_LT(off.back(), 0.1);  // nothing between the two surfaces
}

TEST(Fusion, KeepsToItsLimitOfMemory) {
    FrameFusion all(camera, 0.01), some(camera, 0.01);
    constexpr std::size_t most = 1'000'000;
    some.set_most_bytes(most);
    for (FrameFusion* fusion : {&all, &some}) {
        for (int i = 0; i < 12; ++i) fusion->add(view(static_cast<std::uint64_t>(i), 0.3 * i));
        fusion->flush();
    }
    EXPECT_GT(all.bytes(), 3 * most);
    EXPECT_GT(some.bytes(), most);
    EXPECT_LT(some.bytes(), 2 * most);  // a table a thread, which has just doubled at most
}

// A wall with a board of 4 cm and a post of 2 cm before it. A sensor that bends depths as real ones
// do sees the wall 5 cm off from 3.5 m, to either side; from 1.5 m it sees it right.
DepthFrame bent_view(double from_m, double bend, std::uint64_t seed) {
    test::Random random(seed);
    DepthFrame frame;
    frame.camera_to_world[3] = 0.1 * random.normal();
    frame.camera_to_world[11] = 3.5 - from_m;
    for (std::uint32_t v = 0; v < camera.height; ++v) {
        for (std::uint32_t u = 0; u < camera.width; ++u) {
            const auto x_at = [&](double z) {
                return (u - camera.cx) / camera.fx * z + frame.camera_to_world[3];
            };
            double z = from_m;
            if (std::abs(x_at(from_m - 0.04) - 0.4) < 0.15) z = from_m - 0.04;
            if (std::abs(x_at(from_m - 0.3) + 0.2) < 0.01) z = from_m - 0.3;
            const double off = bend * z * z + depth_sigma(z) * random.normal();
            frame.depth.push_back(static_cast<std::uint16_t>(std::lround(1000 * (z + off))));
        }
    }
    return frame;
}

TEST(Fusion, CopiesThatFarFramesMakeOfASurfaceGo) {
    FrameFusion fusion(camera, 0.01);
    for (int i = 0; i < 24; ++i) {
        const auto seed = static_cast<std::uint64_t>(i);
        fusion.add(bent_view(3.5, i % 2 ? 0.003 : -0.003, seed));
        if (i % 4 == 0) fusion.add(bent_view(1.5, 0, 100 + seed));
    }
    const FusedCloud fused = fusion.finish();
    std::size_t copies = 0, wall = 0, board = 0, post = 0;
    for (std::size_t i = 0; i < fused.cloud.size(); ++i) {
        const double x = fused.cloud.x[i], y = fused.cloud.y[i], z = fused.cloud.z[i];
        // Where the near frames look.
        if (std::abs(x) > 0.6 || std::abs(y) > 0.4) continue;
        const bool on_board = std::abs(x - 0.4) < 0.13, by_board = std::abs(x - 0.4) < 0.2;
        wall += !by_board && std::abs(z - 3.5) < 0.015;
        board += on_board && std::abs(z - 3.46) < 0.015;
        post += std::abs(x + 0.2) < 0.02 && std::abs(z - 3.2) < 0.02;
        copies += (!by_board && z > 3.4 && std::abs(z - 3.5) > 0.03) ||
                  (on_board && std::abs(z - 3.46) > 0.03);
    }
    EXPECT_GT(wall, 4000u);
    EXPECT_GT(board, 1500u);
    EXPECT_GT(post, 60u);
    EXPECT_LT(copies, wall / 100);
}

// Of a long sequence some frames are kept as witnesses; what they say holds for all.
TEST(Fusion, LongSequencesKeepSomeWitnesses) {
    Witnesses witnesses(camera);
    for (std::size_t i = 0; i < 5 * Witnesses::most_frames; ++i)
        witnesses.add(bent_view(1.5, 0, i));
    // Before the wall, on it, and behind it by what a far reading may be off, and by more.
    const FusedPoints points{
        {0, 0, 0, 0}, {0, 0, 0, 0}, {3.45F, 3.5F, 3.55F, 3.9F}, {0.02F, 0.02F, 0.02F, 0.02F}};
    ThreadPool pool(2);
    EXPECT_EQ(witnesses.deny(points, pool), (std::vector<std::uint8_t>{1, 0, 1, 0}));
}

// Points that lie together are left out at a time where a frame can't see them; one by one, and in
// any order, they are told the same. Some lie out of view, and behind the camera.
TEST(Fusion, WitnessesTellTheSameOfPointsTogetherAndApart) {
    Witnesses witnesses(camera);
    for (std::size_t i = 0; i < 3; ++i) witnesses.add(bent_view(1.5, 0, i));
    FusedPoints all;
    test::Random random(5);
    const auto between = [&](double low, double high) {
        return static_cast<float>(low + (high - low) * random.uniform());
    };
    for (int n = 0; n < 3000; ++n) {
        all.x.push_back(between(-3, 3));
        all.y.push_back(between(-3, 3));
        all.z.push_back(n % 3 == 0 ? between(-1, 4) : between(3.4, 3.6));
        all.sigma.push_back(0.02F);
    }
    ThreadPool pool(2);
    const std::vector<std::uint8_t> told = witnesses.deny(all, pool);
    ThreadPool alone(1);
    for (std::size_t n = 0; n < all.size(); ++n) {
        const FusedPoints one{{all.x[n]}, {all.y[n]}, {all.z[n]}, {all.sigma[n]}};
        ASSERT_EQ(witnesses.deny(one, alone), std::vector{told[n]}) << n;
    }
    EXPECT_GT(std::ranges::count(told, 1), 100);
}

TEST(Fusion, OrderOfFramesDoesNotMatter) {
    FrameFusion forth(camera, 0.01), back(camera, 0.01);
    for (int i = 0; i < 5; ++i) forth.add(view(static_cast<std::uint64_t>(i), 0.02 * i));
    for (int i = 5; i-- > 0;) back.add(view(static_cast<std::uint64_t>(i), 0.02 * i));
    EXPECT_EQ(test::points_of(forth.finish().cloud), test::points_of(back.finish().cloud));
}

TEST(Fusion, RefusesWhatIsNoFrame) {
    FrameFusion fusion(camera, 0.01);
    DepthFrame frame;
    EXPECT_THROW(fusion.add(frame), Error);
    frame = view(1, 0);
    frame.camera_to_world[0] = std::nan("");
    EXPECT_THROW(fusion.add(frame), Error);
    EXPECT_EQ(fusion.finish().cloud.size(), 0u);
    EXPECT_THROW(FrameFusion(camera, 0), Error);
    // Far beyond the grid's reach: readings are counted, not placed.
    FrameFusion far(camera, 0.01);
    frame = view(1, 0);
    frame.camera_to_world[3] = 1e12;
    far.add(frame);
    const FusedCloud none = far.finish();
    EXPECT_EQ(none.cloud.size(), 0u);
    EXPECT_GT(none.cloud.dropped, 10'000u);
}

TEST(Organised, GivesItsFrameBack) {
    for (const double side : {1.0, -1.0}) {  // z forward with y down, and the graphics convention
        PointCloud cloud;
        cloud.width = camera.width;
        cloud.height = camera.height;
        const DepthFrame want = view(1, 0);
        for (std::uint32_t i = 0; i < want.depth.size(); i += 3) {
            const double z = want.depth[i] / 1000.0;
            test::add(cloud, (i % camera.width - camera.cx) / camera.fx * z,
                      side * (i / camera.width - camera.cy) / camera.fy * z, side * z);
            cloud.pixel.push_back(i);
        }
        Intrinsics k;
        DepthFrame frame;
        ASSERT_TRUE(frame_of_organised_cloud(cloud, k, frame));
        EXPECT_NEAR(k.fx, camera.fx, 0.01);
        EXPECT_NEAR(k.cy, camera.cy, 0.01);
        EXPECT_EQ(frame.camera_to_world[5], side);
        for (std::uint32_t i = 0; i < want.depth.size(); i += 3)
            ASSERT_NEAR(frame.depth[i] / k.depth_scale, want.depth[i] / 1000.0, 1e-4);
        for (std::size_t i = 0; i < cloud.size(); ++i) cloud.x[i] = static_cast<float>(i % 7);
        EXPECT_FALSE(frame_of_organised_cloud(cloud, k, frame));
    }
}

// Red where it stands at 1.5 m, and a wall of two greys, as each frame has it.
DepthFrame coloured_view(std::uint64_t seed, double shift, int grey) {
    DepthFrame frame = view(seed, shift);
    for (const std::uint16_t stored : frame.depth) {
        const bool box = stored < 2200;
        for (const int channel : {box ? 200 : grey, box ? 10 : grey, box ? 20 : grey})
            frame.rgb.push_back(static_cast<std::uint8_t>(channel));
    }
    return frame;
}

TEST(Fusion, ColoursAreMeansOfWhatIsFusedOnAnyNumberOfThreads) {
    FusedCloud one;
    for (const unsigned threads : {1u, 2u, 5u}) {
        FrameFusion fusion(camera, 0.01, threads);
        for (int i = 0; i < 8; ++i) {
            fusion.add(coloured_view(static_cast<std::uint64_t>(i), 0.01 * i, i % 2 ? 100 : 140));
            DepthFrame colourless = view(static_cast<std::uint64_t>(20 + i), 0.01 * i);
            if (i == 0) fusion.add(colourless);
            if (i == 1) {
                colourless.rgb.assign(3 * colourless.depth.size(), 0);  // nothing is known
                fusion.add(colourless);
            }
        }
        FusedCloud fused = fusion.finish();
        ASSERT_EQ(fused.cloud.red.size(), fused.cloud.size());
        ASSERT_EQ(fused.cloud.blue.size(), fused.cloud.size());
        if (threads > 1) {
            EXPECT_EQ(test::points_of(one.cloud), test::points_of(fused.cloud));
            EXPECT_EQ(test::colours_of(one.cloud), test::colours_of(fused.cloud));
            EXPECT_EQ(one.viewpoint_of_point, fused.viewpoint_of_point);
            continue;
        }
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < fused.cloud.size(); ++i) {
            const int red = fused.cloud.red[i], green = fused.cloud.green[i];
            if (red == 0) continue;  // seen only where no colour was known
            if (fused.cloud.z[i] < 2) {
                EXPECT_EQ(red, 200);
                EXPECT_EQ(green, 10);
            } else {
                EXPECT_EQ(red, green);
                EXPECT_GE(red, 100);
                EXPECT_LE(red, 140);
                sum += red;
                ++count;
            }
        }
        ASSERT_GT(count, 15'000);
        EXPECT_NEAR(sum / count, 120, 2);
        one = std::move(fused);
    }
}

TEST(Fusion, ColoursOfAnotherSizeAreRefused) {
    FrameFusion fusion(camera, 0.01);
    DepthFrame frame = view(1, 0);
    frame.rgb.assign(frame.depth.size(), 7);
    EXPECT_THROW(fusion.add(frame), Error);
    fusion.add(view(1, 0));
    EXPECT_TRUE(fusion.finish().cloud.red.empty());
}

}  // namespace
}  // namespace topple::geometry
