// SPDX-License-Identifier: MIT
#include "result/check_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "topple/error.h"

namespace topple::io {
namespace {

TEST(CheckScene, BarriersAreOneForEachDirectionAndHeight) {
    Scene scene;
    scene.primitives.resize(1);
    scene.primitives[0].id = scene.primitives[0].object = 0;
    scene.objects.resize(1);
    scene.objects[0].id = 0;
    DirectedBarrier& barriers = scene.objects[0].barrier_by_direction;
    constexpr std::size_t directions = DirectedBarrier::directions;
    barriers.height_m = {0.1, 0.2};
    barriers.direction.resize(directions);
    barriers.push_J.resize(directions);
    barriers.blow_J.resize(2 * directions);
    barriers.blow_Ns.resize(2 * directions);
    EXPECT_NO_THROW(check_scene(scene, "scene.json")) << "what hangs has no pushes over an edge";
    barriers.push_N.resize(directions);
    barriers.push_error_N.resize(directions);
    EXPECT_NO_THROW(check_scene(scene, "scene.json"));
    barriers.push_N.pop_back();
    EXPECT_THROW(check_scene(scene, "scene.json"), Error);
    barriers.push_error_N.pop_back();
    EXPECT_THROW(check_scene(scene, "scene.json"), Error);
}

TEST(CheckScene, NamesTheField) {
    Scene scene;
    scene.manhattan_from_input[0] = NAN;
    try {
        check_scene(scene, "scene.json");
        FAIL() << "a frame that is no number passes";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("manhattan_from_input"), std::string::npos);
    }
}

}  // namespace
}  // namespace topple::io
