// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "core/solid_scene.h"
#include "export/body.h"
#include "export/floor.h"
#include "export/joints.h"
#include "topple/scene.h"

namespace topple::exports {

// A scene as a simulator sees it: bodies that touch and do not overlap. World frame: that of
// Scene::manhattan_from_input, z up, metres.
struct SimScene {
    std::vector<Body> bodies;  // those of the scene's objects first, in their order; then pads
    std::vector<JointedFront> fronts;  // ascending by body
    // Height of the lowest level floor, and where on it nothing stands.
    std::optional<double> floor_m;
    std::optional<FreePlace> free_place;
    double friction = 0.3;
    double gravity_m_s2 = 9.81;
};

// solids: of that scene. visuals: what bodies look like, too; in colours as far as the points of
// `scene` tell. joints: of doors and drawers, as far as its points tell. threads: 0 for as many as
// the machine has. Throws Error(input) where scene and solids don't fit together.
SimScene sim_scene(const Scene& scene, const SolidScene& solids, bool visuals, bool joints,
                   unsigned threads);

}  // namespace topple::exports
