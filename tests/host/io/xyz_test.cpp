// SPDX-License-Identifier: MIT
#include "clouds.h"
#include "files.h"
#include "points/formats/read_cloud.h"

namespace topple::io {
namespace {

using namespace test;

class Xyz : public test::Files {};

TEST_F(Xyz, separators_comments_and_extra_columns) {
    for (const char* text : {
             "# a scan\n1 2 3\n\n4 5 6\n",
             "1,2,3\n4,5,6",
             "1;2;3\r\n4;5;6\r\n",
             "\t1\t2   3 # first\n4, 5, 6 // second\n",
             "1 2 3 255 0 0 0.5\n4 5 6 0 0 9 0.5\n",
             "x y z\n1 2 3\n4 5 6\n",
             "\"X\",\"Y\",\"Z\",\"I\"\n1,2,3,7\n4,5,6,7\n",
             "id,x,y,z\n7,1,2,3\n8,4,5,6\n",
             "east north height\n1 2 3\n4 5 6\n",
             "//X Y Z\n1 2 3\n4 5 6\n",
             "2\n1 2 3\n4 5 6\n",
             "\xEF\xBB\xBF"
             "1 2 3\n4 5 6\n",
         }) {
        const auto cloud = read_cloud(write("a.xyz", text));
        EXPECT_EQ(points_of(cloud), (Points{{1, 2, 3}, {4, 5, 6}})) << text;
        EXPECT_TRUE(cloud.nx.empty()) << text;
    }
}

// Two points, (1.5, -2.25, 1234) and (0.25, 2, 3), as programs of many countries write them.
TEST_F(Xyz, commas_are_decimals_where_something_else_separates) {
    for (const char* text : {
             "1,5;-2,25;1234,0\n0,25;2;3\n",
             "1,5 -2,25 1234\n0,25 2,0 3,0\n",
             "1,5\t-2,25\t1234,0\r\n,25\t2,\t3,0\r\n",
             "1,5, -2,25, 1234,0\n0,25, 2,0, 3,0\n",
             "1,5E+00;-22,5e-1;1,234E+03\n2,5E-01;2,0;3,0\n",
             "1,5;-2,25;1.234,0;\n0,25;2,0;3,0;\n",
             "1.5;-2.25;1,234.0\n0.25;2;3\n",
             "\"1,5\",\"-2,25\",\"1234,0\"\n\"0,25\",\"2\",\"3\"\n",
             "\"1.5\",\"-2.25\",\"1,234\"\n\"0.25\",\"2\",\"3,000.0e-3\"\n",
             "2\n1,5 -2,25 1234,0\n0,25 2,0 3,0\n",
             "\xEF\xBB\xBFx;y;z\n1,5;-2,25;1234,0\n0,25;2,0;3,0\n",
             "x,y,z\n1,5 -2,25 1234,0\n0,25 2,0 3,0\n",
             "x y z\n1,5;-2,25;1234,0\n0,25;2,0;3,0\n",
             "Name;Rechtswert [m];Hochwert [m];H\xC3\xB6he [m]\nTisch, "
             "rund;1,5;-2,25;1234,0\nb;0,25;2;3\n",
             "blau;rot;gr\xC3\xBCn;z;y;x\n1;2;3;1234,0;-2,25;1,5\n1;2;3;3,0;2,0;0,25\n",
             "id,x,y,z\n,1.5,-2.25,1234\n2,0.25,2,3\n",
         }) {
        EXPECT_EQ(points_of(read_cloud(write("a.csv", text))),
                  (Points{{1.5f, -2.25f, 1234}, {0.25f, 2, 3}}))
            << text;
    }
    EXPECT_EQ(read_cloud(write("a.csv", "1;2;3;255;0;1\n4;5;6;7;8;9\n")).red.size(), 2u);
    EXPECT_EQ(read_cloud(write("a.xyz", "1,2,3\r4,5,6\r")).size(), 2u);
}

TEST_F(Xyz, what_commas_mean_is_decided_once) {
    const BadFile cases[] = {
        {"1,5;2,5;3,5\n1.5;2,5;3,5\n", {"line 2", "\"1.5\"", "commas are decimals'"}},
        {"1,5;2,5;3,5\n1.234;2,5;3,5\n", {"line 2", "\"1.234\""}},
        {"1,234.5;2;3\n1,5;2;3\n", {"line 2", "\"1,5\"", "thousands'"}},
        {"1 234,56;2,5;3,5\n", {"line 1", "\"1 234,56\""}},
        {"1,5,2,05,3,25\n-0,5,2,75,3,5\n", {"line 1", "commas", "semicolons"}},
        {"1,5;2,5\n", {"line 1", "2 values", "3 are needed"}},
        {"1,2,3\n1,,3\n", {"line 2", "column 2 is empty"}},
        {"x;y;z\n1;;3\n", {"line 2", "column 2 is empty"}},
        {"x y z i\n1 2 3\n", {"line 2", "3 values", "line 1 names 4 columns"}},
        {"1.5\r2\r3", {"line 1", "1 value"}},
    };
    expect_refused("a.csv", cases, [](const auto& file) { read_cloud(file); });
    std::string late;
    for (int n = 0; n < 300; ++n) late += "1 2 3\n";
    expect_input_error([&] { read_cloud(write("a.xyz", late + "1,5 2 3\n")); },
                       {"line 301", "\"1,5\""});
}

TEST_F(Xyz, poses_are_no_points) {
    const std::string tum = "# t x y z qx qy qz qw\n1.0 0 0 1 0.5 -0.5 0.5 -0.5\n",
                      open3d = "0 0 1\n1 0 0 2\n0 0 -1 0\n0 1 0 1\n0 0 0 1\n";
    for (const std::string& text :
         {tum, tum + "1.1 0 0 1 0.1 0.7 0.1 0.7\n", tum + "1.1 0 0 1 1e-3 0 0.6 0.8",
          std::string("timestamp,tx,ty,tz,qx,qy,qz,qw\n1,0,0,1,0.5,-0.5,0.5,-0.5\n"),
          std::string("1 0 0 2 0 0 -1 0 0 1 0 1\n0.6 -0.8 0 2 0.8 0.6 0 0 0 0 1 1\n"), open3d,
          open3d.substr(6)}) {
        for (const char* name : {"trajectory.txt", "poses.csv", "a.xyz"}) {
            SCOPED_TRACE(text);
            expect_input_error([&] { read_cloud(write(name, text)); },
                               {name, "poses, not of points", "give its folder"});
        }
    }
}

TEST_F(Xyz, points_are_no_poses) {
    for (const char* text : {
             // Intensity, normal, curvature; and the same with a first column that falls.
             "1 2 3 9 0 0 1 0\n4 5 6 9 0.6 0.8 0 0.01\n",
             "1 2 3 9 0.5 0.5 0.5 0.5\n0 5 6 9 0.5 -0.5 0.5 0.5\n",
             // Longer than a quaternion, a row with other columns, and no rotation.
             "1 2 3 9 0.5 0.5 0.5 0.6\n4 5 6 9 0.5 0.5 0.5 0.5\n",
             "1 2 3 9 0.5 0.5 0.5 0.5\n4 5 6 9 0.5 0.5 0.5 0.5 1\n",
             "1 0 0 2 0 1 0 0 0 0 2 1\n1 0 0 2 0 1 0 0 0 0 1 1\n",
             "1 0 0 2\n0 1 0 0\n0 0 1 1\n0 0 1 1\n",
             "1 2 3\n4 5 6\n",
         }) {
        SCOPED_TRACE(text);
        EXPECT_GE(read_cloud(write("a.txt", text)).size(), 2u);
    }
    // Rows beyond those that are looked at are nothing but points.
    std::string many;
    for (int n = 0; n < 20; ++n)
        many += std::to_string(n) + (n < 9 ? " 0 0 1 0.5 0.5 0.5 0.5\n" : " 0 0 1 7 7 7 7\n");
    EXPECT_EQ(read_cloud(write("a.txt", many)).size(), 20u);
}

TEST_F(Xyz, six_columns_are_normals_only_where_they_have_unit_length) {
    const auto normals = read_cloud(write("a.xyz", "1 2 3 0 0 1\n4 5 6 0.6 -0.8 0\n"));
    EXPECT_EQ(normals.ny, (std::vector<float>{0, -0.8f}));
    EXPECT_TRUE(read_cloud(write("a.xyz", "1 2 3 255 0 1\n4 5 6 20 80 0\n")).nx.empty());
    EXPECT_TRUE(read_cloud(write("a.xyz", "1 2 3 0 0 1\n4 5 6 0.2 0.2 0.3\n")).nx.empty());
    EXPECT_TRUE(read_cloud(write("a.xyz", "x y z r g b\n1 2 3 0 0 1\n4 5 6 0 1 0\n")).nx.empty());
    EXPECT_TRUE(read_cloud(write("a.xyz", "1 2 3 0 0 1\n4 5 6\n")).nx.empty());
    EXPECT_EQ(read_cloud(write("a.csv", "nx,ny,nz,x,y,z\n0,0,2,4,5,6\n")).nz,
              (std::vector<float>{1}));
}

TEST_F(Xyz, bad_files_are_refused_with_their_reason) {
    const BadFile cases[] = {
        {"1 2 3\n1 2 three\n", {"line 2", "\"three\""}},
        {"1 2 3\n1 2\n", {"line 2", "2 values", "3 are needed"}},
        {"1 2 3\n1 2 \xff\xfe\n", {"line 2", "\\xff\\xfe"}},
        {std::string("\xff\xfe"
                     "1\0 \0",
                     6),
         {"text in UTF-16", "iconv"}},
        {"1 2 \x1b[2J\n", {"\\x1b[2J"}},
        {"1 2 " + std::string(100000, 'q') + "\n", {"line 1", "..."}},
        {"# nothing\n\n", {"no points"}},
        {"nan nan nan\n", {"none of its 1 point "}},
        {"3\n1 2 3\n4 5 6\n", {"3 points", "has 2"}},
        {"1000000000000\n1 2 3\n", {"1000000000000 points", "has 1"}},
        {"1 2 1e300\n", {"1e+300", "units"}},
    };
    expect_refused("a.xyz", cases, [](const auto& file) { read_cloud(file); });
}

TEST_F(Xyz, six_columns_are_colours_only_where_all_are_bytes) {
    using Bytes = std::vector<std::uint8_t>;
    const auto cloud = read_cloud(write("a.xyz", "1 2 3 255 0 1\n4 5 6 20 80 0\n"));
    EXPECT_EQ(cloud.red, (Bytes{255, 20}));
    EXPECT_EQ(cloud.green, (Bytes{0, 80}));
    EXPECT_EQ(cloud.blue, (Bytes{1, 0}));
    for (const char* none :
         {"1 2 3 255 0 1\n4 5 6 20 80 0.5\n", "1 2 3 0 0 1\n4 5 6 0 1 0\n", "1 2 3 255 0 256\n",
          "1 2 3 255 0 -1\n", "1 2 3 9 9 9\n4 5 6\n", "1 2 3 9 9 9 9\n"})
        EXPECT_TRUE(read_cloud(write("a.xyz", none)).red.empty()) << none;
    // By name they may be as bright as they are.
    for (const char* named :
         {"x y z r g b\n1 2 3 1 0.2 0\n", "Red,Green,Blue,X,Y,Z\n255,51,0,1,2,3",
          "x y z red green blue nx\n1 2 3 65535 13107 0 5\n"}) {
        EXPECT_EQ(read_cloud(write("a.xyz", named)).red, Bytes{255}) << named;
        EXPECT_EQ(read_cloud(path("a.xyz")).green, Bytes{51}) << named;
    }
}

}  // namespace
}  // namespace topple::io
