// SPDX-License-Identifier: MIT
#include "pipeline/explain.h"

#include <gtest/gtest.h>

namespace topple {
namespace {

// An object whose centre of mass lies 0.25 m west of what carries it, with the given barrier.
std::string sentence_of_leaning(double barrier_J, double error_J) {
    StableObject from;
    from.candidate.support_polygon = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    from.tipping.margin_m = -0.25;
    from.instability.mode = "tip";
    from.instability.weakest = {-1, 0, 0};
    from.instability.edge = physics::Ends{Vec3{0, 0, 0}, Vec3{0, 1, 0}};
    ObjectStage objects;
    objects.objects = {from};
    Scene scene;
    scene.voxel_size_m = 0.02;
    scene.objects.resize(1);
    scene.objects[0].barrier_J = barrier_J;
    scene.objects[0].barrier_error_J = error_J;
    scene.objects[0].release_J = 300;
    scene.objects[0].mode = "tip";
    const std::array<Vec3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    explain(SolidParts{}, objects, ToInput(axes), scene);
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

}  // namespace
}  // namespace topple
