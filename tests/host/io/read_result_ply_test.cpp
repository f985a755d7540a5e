// SPDX-License-Identifier: MIT
#include "result/read_result_ply.h"

#include <gtest/gtest.h>

#include <limits>

#include "host/io/files.h"
#include "result/write_ply.h"

namespace topple::io {
namespace {

class ResultPly : public topple::test::Files {
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

TEST_F(ResultPly, PointsAreThoseThatWereWritten) {
    ScenePoints points = two_points();
    points.nx = {1, 0};
    points.ny = {0, 1};
    points.nz = {0, 0};
    write_points_ply(path("points.ply"), points);
    const ScenePoints read = read_points_ply(path("points.ply"));
    EXPECT_EQ(read.x, points.x);
    EXPECT_EQ(read.z, points.z);
    EXPECT_EQ(read.ny, points.ny);
    EXPECT_EQ(read.primitive, points.primitive);
    EXPECT_EQ(read.object, points.object);
    EXPECT_EQ(read.red, points.red);
    EXPECT_EQ(read.blue, points.blue);
}

TEST_F(ResultPly, OfAScanWithoutColoursThereAreNone) {
    ScenePoints points = two_points();
    points.red = points.green = points.blue = {};
    write_points_ply(path("points.ply"), points);
    const ScenePoints read = read_points_ply(path("points.ply"));
    EXPECT_EQ(read.object, points.object);
    EXPECT_TRUE(read.red.empty() && read.nx.empty());
}

TEST_F(ResultPly, VoxelsAreThoseThatWereWritten) {
    const SolidVoxels voxels{{1, 2}, {3, 4}, {5, 6}, {0, 1}, {2, 3}, {0, 1}};
    write_solid_ply(path("solid.ply"), voxels);
    const SolidVoxels read = read_solid_ply(path("solid.ply"));
    EXPECT_EQ(read.y, voxels.y);
    EXPECT_EQ(read.primitive, voxels.primitive);
    EXPECT_EQ(read.object, voxels.object);
    EXPECT_EQ(read.state, voxels.state);
}

TEST_F(ResultPly, DamagedFilesAreRefused) {
    const auto refused = [&](const char* name) {
        topple::test::expect_input_error([&] { read_points_ply(path(name)); }, {name});
    };
    write_points_ply(path("points.ply"), two_points());
    const std::string whole = topple::test::bytes_of_file(path("points.ply"));
    write("short.ply", whole.substr(0, whole.size() - 1));
    refused("short.ply");
    write("ascii.ply",
          "ply\nformat ascii 1.0\nelement vertex 1\nproperty uchar object_red\nend_header\n1\n");
    refused("ascii.ply");
    std::string renamed = whole;
    renamed.replace(renamed.find(" object\n"), 8, " abject\n");
    write("renamed.ply", renamed);
    refused("renamed.ply");
    ScenePoints points = two_points();
    points.y[0] = std::numeric_limits<float>::infinity();
    write_points_ply(path("infinite.ply"), points);
    refused("infinite.ply");
    refused("none.ply");
    topple::test::expect_input_error([&] { read_solid_ply(path("points.ply")); }, {"points.ply"});
}

}  // namespace
}  // namespace topple::io
