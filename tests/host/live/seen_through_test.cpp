// SPDX-License-Identifier: MIT
#include "live/seen_through.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>

#include "live/coarse_frame.h"

// A wall 3 m away, before which a board stands in some frames.
namespace topple::live {
namespace {

constexpr Intrinsics k{64, 48, 60, 60, 31.5, 23.5, 1000};

// The board covers columns [20, 40) of rows [10, 30), `board_mm` away; 0: it is not there.
DepthFrame frame(std::uint16_t board_mm, double x_m = 0) {
    DepthFrame out;
    out.camera_to_world[3] = x_m;
    for (std::size_t v = 0; v < 48; ++v)
        for (std::size_t u = 0; u < 64; ++u)
            out.depth.push_back(board_mm > 0 && u >= 20 && u < 40 && v >= 10 && v < 30 ? board_mm
                                                                                       : 3000);
    return out;
}

std::vector<Gone> gone(const std::vector<DepthFrame>& frames) {
    ThreadPool threads(2);
    std::vector<Gone> out;
    for (Looked& looked : Looks(Projection(k), frames, threads).look([&](std::size_t n) {
             return std::pair(n + 1, frames.size());
         }))
        out.push_back(std::move(looked.through));
    return out;
}

TEST(SeenThrough, WhatLaterFramesSeeBehindHasGone) {
    const std::vector<Gone> found = gone({frame(2000), frame(0), frame(0), frame(0)});
    ASSERT_EQ(found.size(), 4u);
    EXPECT_EQ(found[0].size(), 400u);
    for (const GonePixel& pixel : found[0]) {
        EXPECT_TRUE(pixel.u >= 20 && pixel.u < 40 && pixel.v >= 10 && pixel.v < 30);
        EXPECT_EQ(pixel.stored, 2000);
        EXPECT_EQ(pixel.through, 3);
    }
    for (std::size_t n = 1; n < 4; ++n) EXPECT_TRUE(found[n].empty());
}

TEST(SeenThrough, WhatCameAndWhatOnlyNoiseSeparatesHasNot) {
    for (const Gone& pixels : gone({frame(0), frame(2000), frame(2000)}))
        EXPECT_TRUE(pixels.empty());
    for (const Gone& pixels : gone({frame(2980), frame(0), frame(0)})) EXPECT_TRUE(pixels.empty());
    // Behind the board nobody looks; two of the last three say that it is there.
    for (const Gone& pixels : gone({frame(2000), frame(0), frame(2000), frame(2000)}))
        EXPECT_TRUE(pixels.empty());
    // Another room.
    EXPECT_TRUE(gone({frame(2000), frame(0, 9), frame(0, 9)})[0].empty());
}

// Of frames that do not fit, and of those that a correction made fit worse.
TEST(SeenThrough, PosesThatAreOffTellNothing) {
    ThreadPool threads(2);
    const auto found = [&](double off_m, const std::vector<std::optional<Mat4>>& earlier) {
        std::vector<DepthFrame> frames{frame(2000), frame(0), frame(0), frame(0)};
        for (std::size_t n = 1; n < 4; ++n) frames[n].camera_to_world[11] = off_m;
        const Looked looked =
            Looks(Projection(k), frames, threads, earlier).look([&](std::size_t n) {
                return std::pair(n + 1, frames.size());
            })[0];
        return std::pair(std::ssize(looked.through),
                         std::ranges::count(looked.says, Says::through));
    };
    constexpr std::ptrdiff_t board = 400, all = 46 * 62;
    EXPECT_EQ(found(0, {}), std::pair(board, board));
    // The wall is 3.3 m away, they say, where the first frame saw it 3 m away.
    EXPECT_EQ(found(0.3, {}).second, 0);
    EXPECT_GT(found(0.3, {}).first, all / 2);
    // Where poses are as they were, or better, it counts; so does what nobody knew before.
    const Mat4 right = DepthFrame{}.camera_to_world;
    Mat4 wrong = right, elsewhere = right;
    wrong[11] = 0.3;
    elsewhere[3] = 9;
    for (const Mat4& before : {right, wrong, elsewhere})
        EXPECT_EQ(found(0, {right, before, before, before}), std::pair(board, board));
    // 0.3 m to the side: they fit, but for the board's edge, and did so better before.
    std::vector<DepthFrame> frames{frame(2000), frame(2000, 0.3)};
    const auto edge = [&](const std::vector<std::optional<Mat4>>& earlier) {
        const Looked looked =
            Looks(Projection(k), frames, threads, earlier).look([&](std::size_t n) {
                return std::pair(n + 1, frames.size());
            })[0];
        return std::ranges::count(looked.says, Says::through) > 0;
    };
    EXPECT_TRUE(edge({}));
    EXPECT_FALSE(edge({right, right}));
}

TEST(SeenThrough, OnlyWhatTwoLooksSeeThroughIsLeftOut) {
    const Coarse whole(k);
    for (const std::size_t later : {1, 2}) {
        std::vector<DepthFrame> frames{frame(2000)};
        frames.resize(1 + later, frame(0));
        const Gone pixels = gone(frames)[0];
        EXPECT_EQ(pixels.size(), 400u);
        DepthFrame left = frames[0];
        whole.leave_out(pixels, left);
        EXPECT_EQ(std::ranges::count(left.depth, 0), later == 2 ? 400 : 0);
        EXPECT_EQ(std::ranges::count(left.depth, 3000), 64 * 48 - 400);
    }
}

TEST(SeenThrough, ACoarseImageLooksTheSameWay) {
    Intrinsics fine = k;
    fine.width = 640;
    fine.height = 480;
    const Coarse coarse(fine);
    EXPECT_EQ(coarse.intrinsics().width, 160u);
    EXPECT_EQ(coarse.intrinsics().height, 120u);
    DepthFrame frame;
    for (std::size_t n = 0; n < std::size_t{640} * 480; ++n)
        frame.depth.push_back(static_cast<std::uint16_t>(n % 640 + n / 640));
    const DepthFrame seen = coarse.of(frame);
    ASSERT_EQ(seen.depth.size(), std::size_t{160} * 120);
    // Pixel (10, 7) is pixel (40, 28), which looks where it did.
    EXPECT_EQ(seen.depth[7 * 160 + 10], 68);
    EXPECT_NEAR((10 - coarse.intrinsics().cx) / coarse.intrinsics().fx, (40 - fine.cx) / fine.fx,
                1e-12);
}

}  // namespace
}  // namespace topple::live
