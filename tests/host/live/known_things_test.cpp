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

// Of one frame; of it nothing came or has gone.
ShownObjects shown(std::vector<std::int32_t> objects) {
    const std::size_t count = objects.size();
    return {{0, {std::move(objects), std::vector<Says>(count), std::vector<Says>(count)}}};
}

constexpr Says no = Says::nothing, yes = Says::through;
constexpr Vec3 cup{0.08, 0.08, 0.1}, box{0.4, 0.3, 0.3};

TEST(KnownThings, ThoseThatTheSamePixelsShowKeepTheirIds) {
    KnownThings known;
    Scene scene;
    scene.objects = {building(), object({1, 0, 0}, cup, 0.3), object({2, 0, 0}, box, 9)};
    const auto first = known.name(scene, shown({0, 0, 1, 1, 2, 2, 2, -1}));
    ASSERT_EQ(first.size(), 3u);
    EXPECT_EQ(first[0].id, 0u);
    EXPECT_EQ(first[1].id, 1u);
    EXPECT_EQ(first[2].id, 2u);
    EXPECT_EQ(first[1].change, Change::found);

    // Other numbers, another room's frame, and one pixel that changed sides.
    scene.objects = {building(), object({7, 0, 0}, box, 9), object({6, 0, 0}, cup, 0.3)};
    ShownObjects now = shown({0, 0, 2, 2, 1, 1, 2, -1});
    now[4] = {{1, 1}, {no, no}, {no, no}};
    const auto second = known.name(scene, now);
    ASSERT_EQ(second.size(), 3u);
    EXPECT_EQ(second[1].id, 2u);
    EXPECT_EQ(second[2].id, 1u);
    for (const Thing& thing : second) EXPECT_EQ(thing.change, Change::none);
}

// As behind what is larger, where a model of it lies all the same.
TEST(KnownThings, WhatNoPixelShowsIsKnownByItsPlace) {
    KnownThings known;
    Scene scene;
    scene.objects = {building(), object({1, 0, 0}, cup, 0.3), object({2, 0, 0}, cup, 0.3)};
    known.name(scene, shown({0, 0, 1, 1}));
    scene.objects = {building(), object({2.01, 0, 0}, cup, 0.31), object({1, 0, 0}, cup, 0.3),
                     object({4, 0, 0}, cup, 0.3)};
    const auto things = known.name(scene, shown({0, 0, 2, 2}));
    ASSERT_EQ(things.size(), 4u);
    EXPECT_EQ(things[1].id, 2u);
    EXPECT_EQ(things[1].change, Change::none);
    EXPECT_EQ(things[2].id, 1u);
    EXPECT_EQ(things[3].change, Change::found);
}

TEST(KnownThings, WhatIsElsewhereHasMovedAndTheRestComesAndGoes) {
    KnownThings known;
    Scene scene;
    scene.objects = {building(), object({1, 0, 0}, cup, 0.3), object({2, 0, 0}, box, 9),
                     object({4, 0, 0}, cup, 2)};
    known.name(scene, shown({0, 1, 1, 2, 2, 3, 3}));
    // The cup lies on its side 0.5 m from there, another thing has come, and one was found; the box
    // has gone, and of the last one nobody knows.
    scene.objects = {building(), object({1, 0.5, 0}, {0.1, 0.08, 0.08}, 0.35),
                     object({3, 0, 0}, {1, 1, 1}, 90), object({3, 3, 0}, {1, 1, 1}, 20)};
    ShownObjects now = shown({0, -1, -1, 0, 0, -1, -1});
    now[0].later = {no, yes, yes, yes, no, no, no};
    now[1] = {{1, 1, 2, 2, 3, 3}, {no, no, no, no, no, no}, {yes, yes, yes, yes, no, no}};
    const auto things = known.name(scene, now);
    ASSERT_EQ(things.size(), 6u);
    EXPECT_EQ(things[1].id, 1u);
    EXPECT_EQ(things[1].object, 1);
    EXPECT_EQ(things[1].change, Change::moved);
    EXPECT_NEAR(things[1].moved_m, 0.5, 1e-9);
    EXPECT_EQ(things[2].id, 4u);
    EXPECT_EQ(things[2].change, Change::came);
    EXPECT_EQ(things[3].id, 5u);
    EXPECT_EQ(things[3].change, Change::found);
    EXPECT_EQ(things[4].id, 2u);
    EXPECT_EQ(things[4].change, Change::gone);
    EXPECT_EQ(things[4].object, -1);
    EXPECT_EQ(things[5].id, 3u);
    EXPECT_EQ(things[5].change, Change::lost);
    // What is gone or lost is told once.
    EXPECT_EQ(known.name(scene, now).size(), 4u);
}

TEST(KnownThings, WhatStandsALittleAsideHasMoved) {
    KnownThings known;
    Scene scene;
    scene.objects = {building(), object({1, 0, 0}, box, 9)};
    known.name(scene, shown({0, 1, 1, 1, 1}));
    scene.objects[1].box_middle_m[1] = 0.1;
    ShownObjects now = shown({0, -1, 1, 1, 1});
    EXPECT_EQ(known.name(scene, now)[1].change, Change::none);
    scene.objects[1].box_middle_m[1] = 0.2;
    now[0].later[1] = yes;
    known.name(scene, shown({0, 1, 1, 1, 1}));
    scene.objects[1].box_middle_m[1] = 0.3;
    EXPECT_EQ(known.name(scene, now)[1].change, Change::moved);
}

TEST(KnownThings, ChangesAreOtherSupportsAndOtherCategories) {
    KnownThings known;
    Scene scene;
    scene.objects = {building(), object({1, 0, 0}, cup, 0.3), object({2, 0, 0}, box, 9)};
    scene.supports = {{0, 2, 0.1}, {2, 1, 0.01}};
    const ShownObjects pixels = shown({0, 1, 1, 2, 2});
    known.name(scene, pixels);
    EXPECT_EQ(known.name(scene, pixels)[1].change, Change::none);
    scene.supports[1].supporter = 0;
    EXPECT_EQ(known.name(scene, pixels)[1].change, Change::changed);
    scene.objects[2].unsafety_category = "high";
    const auto last = known.name(scene, pixels);
    EXPECT_EQ(last[1].change, Change::none);
    EXPECT_EQ(last[2].change, Change::changed);
}

}  // namespace
}  // namespace topple::live
