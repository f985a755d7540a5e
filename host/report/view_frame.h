// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "topple/scene.h"

namespace topple::report {

// The rows of a transform's rotation.
std::array<Vec3, 3> rotation_of(const Mat4& transform);

// The rows of the rotation from the input to the view: the scene's own frame where it has one with
// z up, else any with z up.
std::array<Vec3, 3> view_frame(const Scene& scene);

// A place or direction of the input in the view, and one of the view in the input.
Vec3 turned(const std::array<Vec3, 3>& view_from_input, const Vec3& p);
Vec3 turned(const std::array<Vec3, 3>& view_from_input, double x, double y, double z);
Vec3 turned_back(const std::array<Vec3, 3>& view_from_input, const Vec3& p);

bool finite(const Vec3& p);

// Around places of the view.
struct Extent {
    Vec3 low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};
    void add(const Vec3& p);
    bool empty() const { return low[0] > high[0]; }
};

}  // namespace topple::report
