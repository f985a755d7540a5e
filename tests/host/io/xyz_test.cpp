// SPDX-License-Identifier: MIT
#include "clouds.h"
#include "io/open_file.h"
#include "las_files.h"
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

// Clouds in portions are the same as whole ones.

class Stream : public test::Files {
  protected:
    static void expect_same(const std::filesystem::path& file, double unit_m = 1) {
        SCOPED_TRACE(file);
        ASSERT_TRUE(can_stream(file));
        const PointCloud whole = read_cloud(file, unit_m);
        PointCloud joined;
        const PointCloud rest = stream_cloud(file, unit_m, [&](const PointCloud& portion) {
            for (const auto& p : test::points_of(portion)) test::add(joined, p);
            joined.dropped += portion.dropped;
        });
        EXPECT_EQ(rest.size(), 0u);
        EXPECT_EQ(test::points_of(joined), test::points_of(whole));
        EXPECT_EQ(joined.dropped, whole.dropped);
        EXPECT_EQ(rest.offset_m, whole.offset_m);
    }
};

// More rows than text is held at a time, some of them not finite.
TEST_F(Stream, TextInAllItsForms) {
    std::string rows;
    constexpr int count = 70'000;
    for (int n = 0; n < count; ++n) {
        const std::string row =
            n % 1000 == 7 ? "nan 0 0\n"
                          : std::to_string(n % 311) + " " + std::to_string(n / 311) + " 0.25\n";
        rows += row;
    }
    const std::string points = std::to_string(count);
    expect_same(write("rows.xyz", rows));
    expect_same(write("rows.xyz", rows), 0.01);
    expect_same(write("rows.pts", points + "\n" + rows));
    expect_same(write("rows.ply", "ply\nformat ascii 1.0\nelement vertex " + points +
                                      "\nproperty float x\nproperty float y\nproperty float z\n"
                                      "end_header\n" +
                                      rows));
    expect_same(write("rows.pcd",
                      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"
                      "COUNT 1 1 1\nWIDTH " +
                          points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points +
                          "\nDATA ascii\n" + rows));
}

TEST_F(Stream, LasIsMovedAsAWhole) {
    test::LasFile las;
    las.offset = {500'000, 5'400'000, 300};
    for (int n = 0; n < 5000; ++n) las.points.push_back({n * 10, n % 70 * 10, n % 3});
    las.withheld = {3, 77};
    const auto file = write("far.las", las.bytes());
    expect_same(file);
    EXPECT_NE(stream_cloud(file, 1, [](const PointCloud&) {}).offset_m, (Vec3{0, 0, 0}));
}

TEST_F(Stream, AMappedFileIsWholeAfterItsMemoryWasGivenBack) {
    const auto file = write("bytes.txt", std::string(100'000, 'x') + "y");
    const MappedFile mapped(file);
    ASSERT_EQ(mapped.text().size(), 100'001u);
    EXPECT_EQ(mapped.text().front(), 'x');
    mapped.release();
    EXPECT_EQ(mapped.text().front(), 'x');
    EXPECT_EQ(mapped.text().back(), 'y');
    EXPECT_THROW(MappedFile{folder_}, Error);
    EXPECT_THROW(MappedFile(folder_ / "away"), Error);
    EXPECT_THROW(MappedFile(write("empty", "")), Error);
}

TEST_F(Stream, FaultsAreToldInTheirPlace) {
    const std::pair<const char*, test::BadFile> cases[] = {
        {"none.xyz", {"# nothing\n", {}}},
        {"nan.xyz", {"nan nan nan\n", {"finite"}}},
        {"bad.xyz", {"1 2 3\n1 2 x\n", {"line 2"}}},
        {"few.pts", {"5\n1 2 3\n", {"promises 5"}}},
    };
    for (const auto& [name, bad] : cases)
        expect_refused(name, std::span(&bad, 1),
                       [](const auto& file) { stream_cloud(file, 1, [](const PointCloud&) {}); });
}

}  // namespace
}  // namespace topple::io
