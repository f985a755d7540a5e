// SPDX-License-Identifier: MIT
#include "topple/object_at.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "host/pipeline/scan.h"
#include "host/pipeline/small_room.h"

// From a place to the object there.
namespace topple::test {
namespace {

ParseResult three_points() {
    ParseResult result;
    result.scene.points.x = {0, 1, 3, 2};
    result.scene.points.y = result.scene.points.z = {0, 0, 0, 0};
    result.scene.points.object = {4, 7, 7, -1};
    return result;
}

TEST(ObjectAt, IsThatOfTheNearestPointOfOne) {
    const ParseResult result = three_points();
    EXPECT_EQ(object_at(result, {0.4, 0, 0}, 0.5), 4);
    EXPECT_EQ(object_at(result, {0.5, 0, 0}, 0.5), 4) << "of two as near the earlier";
    EXPECT_EQ(object_at(result, {0.6, 0, 0}, 0.5), 7);
    EXPECT_EQ(object_at(result, {2, 0, 0}, 1), 7) << "what belongs to nothing doesn't count";
    EXPECT_EQ(object_at(result, {0, 0.3, 0.4}, 0.5), 4);
    EXPECT_EQ(object_at(result, {0, 0.3, 0.4}, 0.49), -1);
    EXPECT_EQ(object_at(result, {0, 0, 0}, 0), 4);
    EXPECT_EQ(object_at(result, {1e9, 0, 0}, INFINITY), 7);
    EXPECT_EQ(object_at(ParseResult{}, {0, 0, 0}, INFINITY), -1);
}

std::string refusal_at(const ParseResult& result, const Vec3& place, double within_m) {
    try {
        object_at(result, place, within_m);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        return error.what();
    }
    return "found";
}

TEST(ObjectAt, RefusesWhatMakesNoSense) {
    ParseResult result = three_points();
    EXPECT_EQ(
        refusal_at(result, {0, NAN, 0}, 1),
        "object_at: place_m (0, nan, 0): expected metres in the frame of the result's points, "
        "all finite");
    EXPECT_EQ(refusal_at(result, {0, 0, 0}, -1),
              "object_at: within_m -1: expected metres from 0 on");
    EXPECT_THAT(refusal_at(result, {0, 0, 0}, NAN), testing::HasSubstr("within_m nan"));
    result.scene.points.x.clear();
    EXPECT_THAT(refusal_at(result, {0, 0, 0}, 1), testing::HasSubstr("add_coordinates()"));
}

TEST(ObjectAt, OfAParsedRoom) {
    const SmallRoom room = SmallRoom::scattered();
    ParseOptions options = on(device::open_device("native"));
    options.disturbances = {};
    const ParseResult result = parse(room.cloud, options);
    const std::int32_t floor = object_at(result, {0.4, 0.4, 0}, 0.05),
                       crate = object_at(result, {1.05, 0.95, 0.5}, 0.05),
                       box = object_at(result, {1.3, 1.2, 0.85}, 0.05);
    ASSERT_GE(floor, 0);
    ASSERT_GE(crate, 0);
    ASSERT_GE(box, 0);
    EXPECT_TRUE(result.scene.objects[floor].grounded);
    EXPECT_NE(crate, floor);
    EXPECT_NE(box, crate);
    EXPECT_EQ(object_at(result, {1.3, 1.2, 1.2}, 0.05), -1) << "in the air";
}

}  // namespace
}  // namespace topple::test
