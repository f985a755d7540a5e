// SPDX-License-Identifier: MIT
#include <cmath>

#include "clouds.h"
#include "files.h"
#include "las_files.h"
#include "points/formats/read_cloud.h"

namespace topple::io {
namespace {

using namespace test;

class Las : public test::Files {};

TEST_F(Las, points_of_every_version_and_format) {
    for (const unsigned minor : {0u, 1u, 2u, 3u, 4u}) {
        for (unsigned format = 0; format <= 10; ++format) {
            SCOPED_TRACE(std::to_string(minor) + " " + std::to_string(format));
            LasFile las;
            las.minor = minor;
            las.format = format;
            las.points = {{1000, -2000, 3000}, {1500, 2500, -3500}};
            const auto cloud = read_cloud(write("a.las", las.bytes()));
            EXPECT_EQ(points_of(cloud), (Points{{1, -2, 3}, {1.5f, 2.5f, -3.5f}}));
            EXPECT_EQ(cloud.offset_m, (Vec3{0, 0, 0}));
        }
    }
}

// A house in UTM coordinates, to the millimetre.
TEST_F(Las, coordinates_far_away_keep_their_precision) {
    LasFile las;
    las.offset = {500000, 5400000, 0};
    las.points = {{123456789, 87654321, 1234}, {123456790, 87654320, 2345}};
    const auto cloud = read_cloud(write("a.las", las.bytes()));
    ASSERT_EQ(cloud.size(), 2u);
    for (std::size_t n = 0; n < 2; ++n) {
        EXPECT_NEAR(cloud.x[n] + cloud.offset_m[0], 500000 + las.points[n][0] * 1e-3, 1e-6);
        EXPECT_NEAR(cloud.y[n] + cloud.offset_m[1], 5400000 + las.points[n][1] * 1e-3, 1e-6);
        EXPECT_NEAR(cloud.z[n] + cloud.offset_m[2], las.points[n][2] * 1e-3, 1e-6);
        EXPECT_LT(std::abs(cloud.x[n]), 2);
    }
    ASSERT_EQ(cloud.notes.size(), 1u);
    EXPECT_THAT(cloud.notes[0], testing::HasSubstr("offset_m"));
    // Where its numbers begin, as a scanner that was moved there still has its own place.
    EXPECT_NEAR(cloud.origin_m[0] + cloud.offset_m[0], 500000, 1e-6);
    EXPECT_NEAR(cloud.origin_m[1] + cloud.offset_m[1], 5400000, 1e-6);
    // Feet, or what they may be.
    const auto scaled = read_cloud(path("a.las"), 0.3048);
    EXPECT_NEAR(scaled.x[0] + scaled.offset_m[0], 0.3048 * (500000 + 123456.789), 1e-6);
}

TEST_F(Las, withheld_points_are_dropped) {
    for (const unsigned format : {0u, 6u}) {
        LasFile las;
        las.minor = 4;
        las.format = format;
        las.points = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
        las.withheld = {1};
        const auto cloud = read_cloud(write("a.las", las.bytes()));
        EXPECT_EQ(cloud.size(), 2u);
        EXPECT_EQ(cloud.dropped, 1u);
    }
}

TEST_F(Las, bad_files) {
    LasFile good;
    good.points = {{1, 2, 3}, {4, 5, 6}};
    const auto changed = [&](std::size_t at, int byte) {
        auto bytes = good.bytes();
        bytes[at] = static_cast<char>(byte);
        return bytes;
    };
    LasFile nan = good;
    nan.offset[1] = std::nan("");
    LasFile none = good;
    none.points = {};
    const BadFile cases[] = {
        {"LAS", {"\"LASF\""}},
        {"LASF", {"227 bytes", "the file 4"}},
        {changed(24, 2), {"LAS 2.2", "1.0 to 1.4"}},
        {changed(104, 0x80), {"LAZ", "las2las"}},
        {changed(104, 11), {"format 11"}},
        {changed(104, 3), {"20 bytes", "takes 34"}},
        {changed(108, 1), {"258 points", "cut short"}},
        {changed(99, 127), {"cut short"}},
        {good.bytes().substr(0, good.bytes().size() - 1), {"2 points", "cut short"}},
        {nan.bytes(), {"nan", "finite"}},
        {none.bytes(), {"has no points"}},
    };
    expect_refused("a.las", cases, [](const auto& file) { read_cloud(file); });
    expect_input_error([&] { read_cloud(write("a.laz", changed(104, 0x81))); }, {"LAZ"});
}

// Beyond that, coordinates a scale apart are one number.
TEST_F(Las, offsets_that_swallow_the_scale) {
    LasFile las;
    las.points = {{0, 0, 0}, {1, 2, 3}};
    las.offset = {1e12, 0, -1e12};
    EXPECT_EQ(read_cloud(write("a.las", las.bytes())).x.size(), 2u);
    for (const double offset : {1e15, -1e15, 1e300}) {
        las.offset = {0, offset, 0};
        expect_input_error([&] { read_cloud(write("a.las", las.bytes())); },
                           {"a.las", "offset", "scale of 0.001 is lost"});
    }
}

TEST_F(Las, colours_of_16_bits_or_of_8) {
    for (const unsigned format : {2u, 3u, 5u, 7u, 8u, 10u}) {
        for (const unsigned step : {1u, 257u}) {
            SCOPED_TRACE(std::to_string(format) + " " + std::to_string(step));
            LasFile las;
            las.minor = 4;
            las.format = format;
            las.points = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
            las.withheld = {1};
            for (const unsigned v : {200u, 40u, 0u}) {
                las.colours.push_back(
                    {static_cast<std::uint16_t>(v * step), static_cast<std::uint16_t>(step), 0});
            }
            const auto cloud = read_cloud(write("a.las", las.bytes()));
            EXPECT_EQ(colours_of(cloud), (Colours{{200, 1, 0}, {0, 1, 0}}));
            las.colours.clear();
            EXPECT_TRUE(read_cloud(write("a.las", las.bytes())).red.empty()) << "room for them";
        }
    }
}

}  // namespace
}  // namespace topple::io
