// SPDX-License-Identifier: MIT
#include "topple/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "compare/align.h"
#include "compare/matching.h"
#include "core/rotation.h"
#include "core/vectors.h"
#include "host/compare/made_rooms.h"
#include "topple/error.h"

// Rooms of voxels that lie on each other however they are turned, and what became of their things.
namespace topple::test {
namespace {

constexpr std::array<int, 3> table{24, 14, 15}, chair{9, 9, 18}, lamp{4, 4, 12};

MadeRoom room() {
    MadeRoom out;
    out.boxes = {{{5, 4, 0}, table},
                 {{40, 10, 0}, chair},
                 {{10, 8, 15}, lamp, "low", 1},
                 {{70, 45, 0}, {10, 15, 38}}};
    return out;
}
// Another scan of it, in a frame of its own.
MadeRoom turned(MadeRoom of) {
    of.quarters = 3;
    of.shift = {31, -7, 4};
    of.yaw_deg = 7;
    return of;
}

Alignment aligned(const MadeRoom& a, const MadeRoom& b) {
    return comparing::align(a.side(), b.side(), [] {});
}

TEST(Align, FindsTurnAndShift) {
    const MadeRoom a = room(), b = turned(room());
    const Alignment found = aligned(a, b);
    EXPECT_FALSE(found.same_frame);
    EXPECT_GT(found.agreeing, 0.99);
    EXPECT_LT(found.next_agreeing, 0.95);
    EXPECT_LT(found.error_m, 0.01);
    for (const Eigen::Vector3d& place :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(4, 0, 2), Eigen::Vector3d(1, 3, 0)}) {
        const Eigen::Vector3d of_a = a.input_from_grid() * a.grid_from_room() * place,
                              of_b = b.input_from_grid() * b.grid_from_room() * place;
        const Vec3 at = transformed(found.a_from_b, {of_b.x(), of_b.y(), of_b.z()});
        EXPECT_LT(length(minus(at, {of_a.x(), of_a.y(), of_a.z()})), 0.01);
    }
}

TEST(Align, OneFrameIsTakenWhereItFits) {
    MadeRoom empty;  // it looks the same turned by half
    EXPECT_TRUE(aligned(empty, empty).same_frame);
    EXPECT_TRUE(aligned(room(), room()).same_frame);
}

std::string refused(const MadeRoom& a, const MadeRoom& b) {
    try {
        aligned(a, b);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    return "";
}

TEST(Align, RefusesWhatDoesNotMatchAndWhatMatchesTwice) {
    MadeRoom other;
    other.size = {56, 33, 60};
    other.boxes = {{{5, 4, 0}, {40, 8, 50}}, {{30, 20, 0}, {8, 8, 30}}};
    EXPECT_THAT(refused(room(), turned(other)), testing::HasSubstr("the rooms do not match"));
    const MadeRoom empty;
    EXPECT_THAT(refused(empty, turned(empty)), testing::HasSubstr("fit in two ways"));
}

std::map<std::int32_t, ComparedThing> by_a(const std::vector<ComparedThing>& things) {
    std::map<std::int32_t, ComparedThing> out;
    for (const ComparedThing& thing : things)
        if (thing.a >= 0) out[thing.a] = thing;
    return out;
}

TEST(Matching, SaysWhatWentCameAndMoved) {
    const MadeRoom a = room();
    MadeRoom later = room();
    later.boxes[1].low = {52, 30, 0};           // the chair
    later.boxes[2] = {{60, 5, 0}, {6, 14, 6}};  // a box came, the lamp went
    later.boxes[3].category = "high";           // the cupboard
    for (const MadeRoom& b : {later, turned(later)}) {
        const comparing::Side of_a = a.side(), of_b = b.side();
        const Alignment laid = comparing::align(of_a, of_b, [] {});
        const auto things = comparing::match_things(of_a, of_b, laid.a_from_b);
        ASSERT_EQ(things.size(), 5u);
        auto of = by_a(things);
        EXPECT_EQ(of[1].became, Became::same);
        EXPECT_EQ(of[1].b, 1);
        EXPECT_EQ(of[2].became, Became::moved);
        EXPECT_EQ(of[2].b, 2);
        EXPECT_NEAR(of[2].moved_m, 0.05 * std::hypot(12, 20), 0.01);
        EXPECT_EQ(of[3].became, Became::went);
        EXPECT_GT(of[3].free, 0.6);
        EXPECT_EQ(of[4].became, Became::same);
        EXPECT_TRUE(of[4].less_safe);
        EXPECT_FALSE(of[1].less_safe || of[2].less_safe);
        EXPECT_EQ(things[4].became, Became::came);
        EXPECT_EQ(things[4].b, 3);
    }
}

TEST(Matching, WhatTheOtherScanDidNotSeeIsUnseen) {
    MadeRoom b = room();
    b.boxes.erase(b.boxes.begin() + 1, b.boxes.begin() + 3);
    b.unseen_low = {36, 6, 0};
    b.unseen_size = {18, 18, 25};
    const comparing::Side of_a = room().side(), of_b = b.side();
    auto of = by_a(comparing::match_things(of_a, of_b, aligned(room(), b).a_from_b));
    EXPECT_EQ(of[2].became, Became::unseen);
    EXPECT_EQ(of[3].became, Became::went);
    EXPECT_EQ(of[4].b, 2);
}

TEST(Matching, WhatWasToldApartOtherwiseHasNotGone) {
    MadeRoom b = room();
    // The lamp is a part of the table.
    b.boxes.erase(b.boxes.begin() + 2);
    comparing::Side of_a = room().side(), of_b = b.side();
    MadeRoom with = room();
    Scene& scene = of_b.scene;
    comparing::Side joined = with.side();
    for (std::int32_t& object : joined.scene.solid.object)
        object = object == 3 ? 1 : object == 4 ? 3 : object;
    joined.scene.objects = scene.objects;
    joined.scene.primitives = scene.primitives;
    joined.scene.supports = scene.supports;
    SpaceMap space;
    const comparing::Side again{joined.scene, comparing::SeenSpace(joined.scene, space),
                                joined.surface};
    auto of = by_a(
        comparing::match_things(of_a, again, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}));
    EXPECT_EQ(of[3].became, Became::merged);
    EXPECT_EQ(of[1].became, Became::same);
}

TEST(Matching, WhatStandsOnOtherThingsStandsOtherwise) {
    MadeRoom b = room();
    b.boxes[2].low = {43, 12, 18};  // the lamp, on the chair
    b.boxes[2].on = 2;
    const comparing::Side of_a = room().side(), of_b = b.side();
    auto of = by_a(comparing::match_things(of_a, of_b, aligned(room(), b).a_from_b));
    EXPECT_EQ(of[3].became, Became::moved);
    EXPECT_TRUE(of[3].stands_otherwise);
    EXPECT_FALSE(of[1].stands_otherwise || of[2].stands_otherwise);
}

}  // namespace
}  // namespace topple::test
