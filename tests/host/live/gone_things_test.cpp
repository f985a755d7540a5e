// SPDX-License-Identifier: MIT
#include "live/gone_things.h"

#include <gtest/gtest.h>

#include <algorithm>

// A wall 3 m away, before which a board leans in the first frames: its lower rows are too near the
// wall for later frames to see through.
namespace topple::live {
namespace {

constexpr Intrinsics small_camera{64, 48, 60, 60, 31.5, 23.5, 1000};
constexpr std::size_t foot = 22, end = 30;  // rows

DepthFrame leaning(bool board, double x_m = 0) {
    DepthFrame out;
    out.camera_to_world[3] = x_m;
    for (std::size_t v = 0; v < 48; ++v)
        for (std::size_t u = 0; u < 64; ++u)
            out.depth.push_back(
                board && u >= 20 && u < 40 && v >= 10 && v < end ? (v < foot ? 2000 : 2980) : 3000);
    return out;
}

std::vector<std::uint32_t> board_pixels() {
    std::vector<std::uint32_t> out;
    for (std::uint32_t v = 10; v < end; ++v)
        for (std::uint32_t u = 20; u < 40; ++u) out.push_back(64 * v + u);
    return out;
}

struct Film {
    explicit Film(std::vector<DepthFrame> of) : images(std::move(of)) {
        for (FrameId n = 0; n < images.size(); ++n) ids.push_back(2 * n);
        ThreadPool threads(2);
        later = Looks(projection, images, threads).look([&](std::size_t n) {
            return std::pair(n + 1, images.size());
        });
    }
    FramesLooked looked() const { return {projection, ids, images, later}; }
    Projection projection{small_camera};
    std::vector<FrameId> ids;
    std::vector<DepthFrame> images;
    std::vector<Looked> later;
};

ThingPixels gone_from(const ThingPixels& thing, const FramesLooked& frames) {
    return gone_of({thing}, frames)[0];
}

TEST(GoneThings, WhatOfAThingCannotBeToldGoesWithTheRest) {
    const Film film({leaning(true), leaning(true), leaning(false), leaning(false)});
    // Frame 6 shows what is there now, 5 there is none.
    const ThingPixels gone = gone_from(
        {{0, board_pixels()}, {2, board_pixels()}, {5, board_pixels()}, {6, board_pixels()}},
        film.looked());
    ASSERT_EQ(gone.size(), 2u);
    EXPECT_EQ(gone.at(0).size(), 400u);
    EXPECT_TRUE(gone.contains(2));

    std::vector<Gone> through(film.ids.size());
    add_things(std::vector{gone}, film.looked(), through);
    EXPECT_EQ(through[0].size(), 400u);
    EXPECT_TRUE(std::ranges::all_of(through[0], &GonePixel::is_sure));
    EXPECT_TRUE(through[2].empty() && through[3].empty());
}

TEST(GoneThings, FramesBetweenLoseItByItsPlace) {
    const Film film(
        {leaning(true), leaning(true, 0.02), leaning(true), leaning(false), leaning(false)});
    const ThingPixels gone = gone_from({{0, board_pixels()}, {4, board_pixels()}}, film.looked());
    ASSERT_EQ(gone.size(), 2u);
    std::vector<Gone> through(film.ids.size());
    add_things(std::vector{gone}, film.looked(), through);
    const auto rows = [&](std::size_t from, std::size_t to) {
        return std::ranges::count_if(through[1],
                                     [&](const GonePixel& p) { return p.v >= from && p.v < to; });
    };
    EXPECT_GT(rows(10, foot), 200);
    EXPECT_LT(rows(0, 10) + rows(end, 48), 50);
}

TEST(GoneThings, WhatIsThereStays) {
    const Film film({leaning(true), leaning(true), leaning(true)});
    EXPECT_TRUE(gone_from({{0, board_pixels()}, {2, board_pixels()}}, film.looked()).empty());
    EXPECT_TRUE(gone_from({}, film.looked()).empty());
    // A few pixels tell nothing.
    std::vector<DepthFrame> holes{leaning(true), leaning(true), leaning(true)};
    for (std::size_t n = 1; n < 3; ++n)
        for (std::size_t v = 12; v < 17; ++v)
            for (std::size_t u = 22; u < 27; ++u) holes[n].depth[64 * v + u] = 3000;
    const Film few(holes);
    EXPECT_TRUE(gone_from({{0, board_pixels()}}, few.looked()).empty());
}

TEST(GoneThings, NotManyAtOnce) {
    const Film film({leaning(true), leaning(true), leaning(false), leaning(false)});
    const ThingPixels board{{0, board_pixels()}};
    ThingPixels wall{{0, {}}};
    for (std::uint32_t n = 0; n < 64 * 10; ++n) wall[0].push_back(n);
    const auto gone = [&](std::size_t boards, std::size_t walls) {
        std::vector<ThingPixels> things(boards, board);
        things.insert(things.end(), walls, wall);
        return std::ranges::count_if(gone_of(things, film.looked()),
                                     [](const ThingPixels& thing) { return !thing.empty(); });
    };
    EXPECT_EQ(gone(3, 0), 3);
    EXPECT_EQ(gone(4, 12), 4);
    EXPECT_EQ(gone(4, 11), 0);
    EXPECT_EQ(still_gone({board, wall, board, board, board}, film.looked()).size(), 4u);
}

}  // namespace
}  // namespace topple::live
