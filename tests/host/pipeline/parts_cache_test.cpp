// SPDX-License-Identifier: MIT
#include "scale/parts_cache.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "device/devices.h"
#include "pipeline/stages.h"
#include "small_room.h"

// What a parse goes on from is what was found, not a part of it.
namespace topple::test {
namespace {

namespace fs = std::filesystem;

TEST(PartsCache, HoldsAllThatObjectsAreFoundFrom) {
    const fs::path file = fs::path(::testing::TempDir()) / "topple-groundwork-test.cache";
    ParseOptions options;
    options.device = device::open_device("native");
    options.cache_file = file.string();
    SmallRoom room = SmallRoom::scattered();
    for (const float x : room.cloud.x) room.cloud.red.push_back(x > 1 ? 200 : 90);
    room.cloud.green.assign(room.cloud.size(), 120);
    room.cloud.blue.assign(room.cloud.size(), 60);
    std::vector<std::pair<std::string, double>> timings;
    StageClock stage(timings, options);
    const FoundParts laid =
        find_parts(*options.device, observe_cloud(*options.device, room.cloud, options), options,
                   "room", stage);
    // The key is of files: of this test's own source, say.
    const PartsCache cache(__FILE__, options);
    ASSERT_TRUE(cache.usable());
    cache.write(laid);
    const std::optional<FoundParts> read = cache.read();
    fs::remove(file);
    ASSERT_TRUE(read);
    const SolidParts &was = laid.parts, &is = read->parts;
    EXPECT_EQ(is.model, was.model);
    EXPECT_EQ(is.shell_log_odds, was.shell_log_odds);
    EXPECT_EQ(is.points, was.points);
    EXPECT_EQ(is.frame.axes, was.frame.axes);
    ASSERT_GT(was.samples.size(), 1000u);
    ASSERT_TRUE(was.samples.coloured());
    EXPECT_EQ(is.samples.edge_m, was.samples.edge_m);
    EXPECT_EQ(is.samples.spacing_m, was.samples.spacing_m);
    EXPECT_EQ(is.samples.primitive, was.samples.primitive);
    const auto columns = geometry::columns_of(is.samples),
               first = geometry::columns_of(was.samples);
    for (std::size_t c = 0; c < columns.size(); ++c) EXPECT_EQ(*columns[c], *first[c]) << c;
    EXPECT_EQ(is.solids->cells().primitive, was.solids->cells().primitive);
    EXPECT_EQ(is.solids->boundary().share, was.solids->boundary().share);
    EXPECT_EQ(read->weighed.joints.size(), laid.weighed.joints.size());
    EXPECT_EQ(read->points.primitive, laid.points.primitive);
}

}  // namespace
}  // namespace topple::test
