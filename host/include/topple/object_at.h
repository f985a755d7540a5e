// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "topple/parse.h"

namespace topple {

// The id of the object at a place, in metres in the frame of the result's points (from which
// Scene::offset_m was taken off): that of the nearest point that belongs to one, of two that are as
// near that of the earlier one. -1: there is none within `within_m` metres; infinity: however far.
// Looks at all points, a million in about a millisecond: for the pixels of an image take
// FrameLabeller. Of a cloud that was parsed in blocks the points are a sample.
//
// Throws Error(usage) for a result without its points' coordinates, a place that is not finite, and
// a distance that is NaN or less than 0.
std::int32_t object_at(const ParseResult& result, const Vec3& place_m, double within_m);

}  // namespace topple
