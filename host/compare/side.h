// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "compare/seen_space.h"
#include "topple/scene.h"

namespace topple::comparing {

// A piece of surface in the grid frame: the mean of the points in a small cell.
struct SurfacePoint {
    Vec3 place_m{}, normal{};
    bool building = false;
};

// One of two results that are compared.
struct Side {
    Scene scene;
    SeenSpace space;
    std::vector<SurfacePoint> surface;  // ordered by cell
};

// Reads what write_outputs() has written. poll: called now and then. Throws Error(input).
Side read_side(const std::filesystem::path& folder, const std::function<void()>& poll);

}  // namespace topple::comparing
