// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "clouds.h"
#include "files.h"
#include "io/mapped_file.h"
#include "las_files.h"
#include "points/formats/read_cloud.h"

// Clouds in portions are the same as whole ones.
namespace topple::io {
namespace {

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
