// SPDX-License-Identifier: MIT
#include "io/points_colours.h"

#include <gtest/gtest.h>

#include <limits>

#include "host/io/files.h"
#include "io/write_ply.h"

namespace topple::io {
namespace {

class PointsColours : public topple::test::Files {
  protected:
    static ScenePoints two_points() {
        ScenePoints out;
        out.x = {1, 2};
        out.y = {3, 4};
        out.z = {5, 6};
        out.primitive = {0, -1};
        out.object = {7, -1};
        out.red = {10, 20};
        out.green = {30, 40};
        out.blue = {50, 60};
        return out;
    }
};

TEST_F(PointsColours, AreThoseThatWereWritten) {
    const ScenePoints points = two_points();
    write_points_ply(path("points.ply"), points);
    const ScenePoints read = read_points_colours(path("points.ply"));
    EXPECT_EQ(read.x, points.x);
    EXPECT_EQ(read.z, points.z);
    EXPECT_EQ(read.object, points.object);
    EXPECT_EQ(read.red, points.red);
    EXPECT_EQ(read.blue, points.blue);
}

TEST_F(PointsColours, OfAScanWithoutThemThereAreNone) {
    ScenePoints points = two_points();
    points.red = points.green = points.blue = {};
    write_points_ply(path("points.ply"), points);
    EXPECT_TRUE(read_points_colours(path("points.ply")).x.empty());
    EXPECT_TRUE(read_points_colours(path("none.ply")).x.empty());
}

TEST_F(PointsColours, PointsThatAreNotFiniteAreLeftOut) {
    ScenePoints points = two_points();
    points.y[0] = std::numeric_limits<float>::infinity();
    write_points_ply(path("points.ply"), points);
    EXPECT_EQ(read_points_colours(path("points.ply")).x, std::vector<float>{2});
}

TEST_F(PointsColours, DamagedFilesAreRefused) {
    write_points_ply(path("points.ply"), two_points());
    const std::string whole = topple::test::bytes_of_file(path("points.ply"));
    write("short.ply", whole.substr(0, whole.size() - 1));
    topple::test::expect_input_error([&] { read_points_colours(path("short.ply")); },
                                     {"short.ply"});
    write("ascii.ply",
          "ply\nformat ascii 1.0\nelement vertex 1\nproperty uchar object_red\nend_header\n1\n");
    topple::test::expect_input_error([&] { read_points_colours(path("ascii.ply")); },
                                     {"ascii.ply"});
    std::string renamed = whole;
    renamed.replace(renamed.find(" object\n"), 8, " abject\n");
    write("renamed.ply", renamed);
    topple::test::expect_input_error([&] { read_points_colours(path("renamed.ply")); },
                                     {"renamed.ply"});
}

}  // namespace
}  // namespace topple::io
