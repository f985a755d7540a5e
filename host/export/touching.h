// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "export/body.h"

namespace topple::exports {

// What is no further apart rests on one another.
inline constexpr double resting_m = 2e-4;

// Where two bodies touch along a plane: corners of what their parts share of it.
struct Touch {
    std::size_t below = 0, above = 0;
    Vec3 normal{};  // unit, from the one below to the one above
    std::vector<Vec3> point;
};

// Where two parts touch, with normals from the first to the second; no points where they don't.
Touch touch_of(const ConvexPart& below, const ConvexPart& above);

// All, but those of two fixed bodies; or those of bodies from `first` on with any.
std::vector<Touch> touches_of(const std::vector<Body>& bodies, std::size_t first = 0);

}  // namespace topple::exports
