// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "core/solid_scene.h"
#include "core/thread_pool.h"
#include "export/body.h"
#include "export/floor.h"
#include "topple/scene.h"

namespace topple::exports {

// A scene as a simulator sees it: bodies that touch and do not overlap. World frame: that of
// Scene::manhattan_from_input, z up, metres.
struct SimScene {
    std::vector<Body> bodies;  // those of the scene's objects first, in their order; then pads
    // Height of the lowest level floor, and where on it nothing stands.
    std::optional<double> floor_m;
    std::optional<FreePlace> free_place;
    double friction = 0.3;
    double gravity_m_s2 = 9.81;
};

// solids: of that scene. Throws Error(input) where both don't fit together.
SimScene sim_scene(const Scene& scene, const SolidScene& solids, ThreadPool& threads);

}  // namespace topple::exports
