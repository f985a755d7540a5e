// SPDX-License-Identifier: MIT
#include "lab/evaluation/kind_score.h"

#include <gtest/gtest.h>

#include "lab/rooms/kinds.h"

namespace topple::evaluation {
namespace {

// A parse that found exactly what is there, each object as one primitive.
Scene perfect(const scenes::World& world, const scenes::Scan& scan) {
    Scene scene;
    const auto fixed = scenes::fixed_objects(world);
    const auto body = [&](std::int32_t object) { return fixed[object] ? 0 : object; };
    for (const auto& p : scan.truth) {
        scene.points.x.push_back(static_cast<float>(p.at[0]));
        scene.points.y.push_back(static_cast<float>(p.at[1]));
        scene.points.z.push_back(static_cast<float>(p.at[2]));
        scene.points.object.push_back(body(p.object));
        scene.points.primitive.push_back(p.object);
    }
    for (std::int32_t n = 0; n < static_cast<std::int32_t>(fixed.size()); ++n) {
        Primitive primitive;
        primitive.id = n;
        primitive.object = body(n);
        scene.primitives.push_back(primitive);
        if (body(n) != n) continue;
        Object object;
        object.id = n;
        object.grounded = n == 0;
        scene.objects.push_back(object);
    }
    const auto below = scenes::supporters(world);
    for (std::size_t n = 1; n < below.size(); ++n) {
        const auto id = static_cast<std::int32_t>(n);
        for (const std::int32_t s : below[n]) {
            scene.supports.push_back({body(s), body(id), 0.01});
            Contact contact;
            contact.a = s;
            contact.b = id;
            scene.contacts.push_back(contact);
        }
    }
    return scene;
}

class KindScoring : public ::testing::Test {
  protected:
    const scenes::World world = scenes::make_world("office", 3);
    const scenes::Scan scan = scenes::scan(
        world, {.kind = scenes::ScanKind::laser, .seed = 3, .frames = 0, .spacing_m = 0.03});
    Scene scene = perfect(world, scan);
};

TEST_F(KindScoring, a_perfect_parse_has_all) {
    const KindScore s = judge_kind(world, scan, scene);
    EXPECT_GT(s.objects, 3u);
    EXPECT_EQ(s.miou, 1);
    EXPECT_EQ(s.found, 1);
    EXPECT_EQ(s.found_alone, 1);
    EXPECT_EQ(s.found_best, 1);
    EXPECT_EQ(s.support_recall, 1);
    EXPECT_EQ(s.support_precision, 1);
    EXPECT_EQ(s.swallowed, 0);
}

TEST_F(KindScoring, all_in_the_ground_has_nothing) {
    for (Object& o : scene.objects) o.grounded = true;
    const KindScore s = judge_kind(world, scan, scene);
    EXPECT_EQ(s.found, 0);
    EXPECT_EQ(s.found_alone, 1);
    EXPECT_EQ(s.support_recall, 0);
    EXPECT_EQ(s.swallowed, 1);
    EXPECT_LT(s.joint_precision, 1);
}

TEST(KindsTable, a_row_for_each_kind_and_one_for_all) {
    KindScore a, b;
    a.kind = "kitchen";
    a.found = 0.25;
    b.kind = "office";
    b.found = 0.75;
    const std::string table = kinds_table({a, b});
    for (const char* text : {"kitchen", "office", "all", "25.0", "75.0", "50.0"})
        EXPECT_NE(table.find(text), std::string::npos) << text;
}

}  // namespace
}  // namespace topple::evaluation
