// SPDX-License-Identifier: MIT
#include "live/known_things.h"

#include <gtest/gtest.h>

// Which things are those of before: by pixels, by size and weight where they moved.
namespace topple::live {
namespace {

Object object(Vec3 middle_m, Vec3 size_m, double mass_kg) {
    Object out;
    out.box_middle_m = middle_m;
    out.size_m = size_m;
    out.mass_kg = mass_kg;
    return out;
}

Object building() {
    Object out = object({}, {5, 4, 2.5}, 1000);
    out.grounded = true;
    return out;
}

constexpr Vec3 cup{0.08, 0.08, 0.1}, box{0.4, 0.3, 0.3};

TEST(KnownThings, ThoseThatTheSamePixelsShowKeepTheirIds) {
    KnownThings known;
    Scene scene;
    scene.objects = {building(), object({1, 0, 0}, cup, 0.3), object({2, 0, 0}, box, 9)};
    const auto first = known.name(scene, {{0, {0, 0, 1, 1, 2, 2, 2, -1}}});
    ASSERT_EQ(first.size(), 3u);
    EXPECT_EQ(first[0].id, 0u);
    EXPECT_EQ(first[1].id, 1u);
    EXPECT_EQ(first[2].id, 2u);
    EXPECT_EQ(first[1].change, Change::appeared);

    // Other numbers, another room's frame, and one pixel that changed sides.
    scene.objects = {building(), object({7, 0, 0}, box, 9), object({6, 0, 0}, cup, 0.3)};
    const auto second = known.name(scene, {{0, {0, 0, 2, 2, 1, 1, 2, -1}}, {4, {1, 1}}});
    ASSERT_EQ(second.size(), 3u);
    EXPECT_EQ(second[1].id, 2u);
    EXPECT_EQ(second[2].id, 1u);
    for (const Thing& thing : second) EXPECT_EQ(thing.change, Change::none);
}

TEST(KnownThings, WhatIsElsewhereHasMovedAndTheRestComesAndGoes) {
    KnownThings known;
    Scene scene;
    scene.objects = {building(), object({1, 0, 0}, cup, 0.3), object({2, 0, 0}, box, 9)};
    known.name(scene, {{0, {0, 1, 1, 2, 2}}});
    // The cup lies on its side 0.5 m from there; another thing is where the box was not.
    scene.objects = {building(), object({1, 0.5, 0}, {0.1, 0.08, 0.08}, 0.35),
                     object({3, 0, 0}, {1, 1, 1}, 90)};
    const auto now = known.name(scene, {{0, {0, -1, -1, 0, 0}}});
    ASSERT_EQ(now.size(), 4u);
    EXPECT_EQ(now[1].id, 1u);
    EXPECT_EQ(now[1].change, Change::moved);
    EXPECT_NEAR(now[1].moved_m, 0.5, 1e-9);
    EXPECT_EQ(now[2].id, 3u);
    EXPECT_EQ(now[2].change, Change::appeared);
    EXPECT_EQ(now[3].id, 2u);
    EXPECT_EQ(now[3].change, Change::vanished);
    EXPECT_EQ(now[3].object, -1);
    // What vanished is told once.
    EXPECT_EQ(known.name(scene, {{0, {0, -1, -1, 0, 0}}}).size(), 3u);
}

TEST(KnownThings, ChangesAreOtherSupportsAndOtherCategories) {
    KnownThings known;
    Scene scene;
    scene.objects = {building(), object({1, 0, 0}, cup, 0.3), object({2, 0, 0}, box, 9)};
    scene.supports = {{0, 2, 0.1}, {2, 1, 0.01}};
    const ShownObjects shown{{0, {0, 1, 1, 2, 2}}};
    known.name(scene, shown);
    EXPECT_EQ(known.name(scene, shown)[1].change, Change::none);
    scene.supports[1].supporter = 0;
    EXPECT_EQ(known.name(scene, shown)[1].change, Change::changed);
    scene.objects[2].unsafety_category = "high";
    const auto last = known.name(scene, shown);
    EXPECT_EQ(last[1].change, Change::none);
    EXPECT_EQ(last[2].change, Change::changed);
}

}  // namespace
}  // namespace topple::live
