// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "geometry/segmentation.h"
#include "geometry/storeys.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// The storeys of a scan that shows more than one room, by rising height; none of one room, which
// has the whole scene in front of each of its walls. Several storeys are those that have a large
// floor each; on a single one, a wall is seen from both sides: two upright faces that look away
// from each other, closer than half a metre, as high as the room and wider than most furniture.
std::vector<StoreyHint> find_building(const Surfels& surfels, const PrimitiveSet& primitives,
                                      const Vec3& up);

}  // namespace topple::geometry
