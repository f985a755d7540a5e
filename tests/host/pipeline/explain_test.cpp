// SPDX-License-Identifier: MIT
#include "pipeline/explain.h"

#include <gtest/gtest.h>

#include "pipeline/sentences.h"

namespace topple {
namespace {

// An object whose centre of mass lies 0.25 m west of what carries it, with the given barrier; where
// it is stopped on its way, by object 1.
std::string sentence_of_leaning(double barrier_J, double error_J, bool stopped = false,
                                bool building = false) {
    StableObject from;
    from.candidate.support_polygon = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    from.tipping.margin_m = -0.25;
    from.instability.mode = "tip";
    from.instability.weakest = {-1, 0, 0};
    from.instability.edge = physics::Ends{Vec3{0, 0, 0}, Vec3{0, 1, 0}};
    ObjectStage objects;
    objects.objects = {from, StableObject{}};
    Scene scene;
    scene.voxel_size_m = 0.02;
    scene.objects.resize(2);
    scene.objects[1].id = 1;
    scene.objects[1].grounded = building;
    scene.primitives.resize(1);
    scene.primitives[0].object = 1;
    scene.objects[0].fall.hits_J = 0.004;
    scene.objects[0].barrier_J = barrier_J;
    scene.objects[0].barrier_error_J = error_J;
    scene.objects[0].release_J = 300;
    scene.objects[0].mode = "tip";
    const std::array<Vec3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    explain(objects, ToInput(axes), scene);
    std::vector<Landing> landings(2);
    landings[0].swept.stopped = stopped;
    landings[0].swept.by = stopped ? 0 : -1;
    SolidParts parts;
    parts.solids = std::make_shared<const SolidScene>(SolidCells{}, std::vector<Role>{Role::wall});
    tell_why(parts, objects, landings, scene);
    return scene.objects[0].why.sentence;
}

TEST(Explain, what_takes_energy_to_go_does_not_fall_as_it_stands) {
    const std::string falls = sentence_of_leaning(0, 5);
    EXPECT_TRUE(falls.starts_with("Falls to the west as it stands: its centre of mass is 0.25 m"))
        << falls;
    for (const double error : {5.0, 500.0}) {
        const std::string tips = sentence_of_leaning(127.5, error);
        EXPECT_EQ(tips.find("as it stands"), std::string::npos) << tips;
        EXPECT_NE(tips.find("is 0.25 m beyond the edge"), std::string::npos) << tips;
        EXPECT_NE(tips.find(error < 127 ? "long, at 128 J" : "long, at between 0 and 628 J"),
                  std::string::npos)
            << tips;
    }
}

TEST(Explain, what_comes_to_lean_does_not_release_what_a_fall_would) {
    const std::string leans = sentence_of_leaning(127.5, 5, true);
    EXPECT_NE(leans.find("; comes to lean on object 1, with 4.0 mJ. If that gave way it would come "
                         "to rest lower and release 300 J, which its risk reckons with."),
              std::string::npos)
        << leans;
    EXPECT_EQ(sentence_of_leaning(127.5, 5).find("lean on"), std::string::npos);
    const std::string on_wall = sentence_of_leaning(127.5, 5, true, true);
    EXPECT_NE(on_wall.find("; comes to lean on a wall, with 4.0 mJ."), std::string::npos)
        << on_wall;
    EXPECT_EQ(on_wall.find("gave way"), std::string::npos) << on_wall;
}

// A fixing's force, in what straps are sold by.
TEST(Explain, straps_are_told_by_what_they_carry) {
    Scene scene;
    scene.objects.resize(4);
    std::vector<Suggestion> suggestions(4);
    const std::array force_N{3.7, 98.0, 99.0, 0.0};
    for (std::size_t o = 0; o < 4; ++o) {
        scene.objects[o].mass_kg = 20;
        scene.objects[o].risk_J = {{"earthquake", 1}};
        suggestions[o].kind = Suggestion::Kind::fix;
        suggestions[o].hold = {force_N[o], 1.5};
    }
    tell_advice(suggestions, scene);
    const auto told = [&](std::size_t o) { return scene.objects[o].advice.sentence; };
    EXPECT_EQ(told(0),
              "Fasten it to the wall or to what carries it, with a strap or bracket rated for 1 kg "
              "or more (it must hold 3.7 N sideways at least, without a margin), 1.5 m above what "
              "it stands on.");
    EXPECT_NE(told(1).find("rated for 10 kg or more (it must hold 98 N"), std::string::npos)
        << told(1);
    EXPECT_NE(told(2).find("rated for 20 kg"), std::string::npos) << told(2);
    EXPECT_EQ(told(3), "Fasten it to the wall or to what carries it.");
}

}  // namespace
}  // namespace topple
