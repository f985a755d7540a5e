// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/role.h"
#include "geometry/manhattan.h"
#include "geometry/segmentation.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// The part that a primitive plays in the room's shell.
using Structure = Role;

// Of a building, or a part of one: what lies beyond its edge is not seen, and walls have rooms on
// both sides.
struct StoreyHint {
    double floor_m = 0;  // height of the storey's floor along up; NaN: not known
    double below_m = -std::numeric_limits<double>::infinity();  // where the storey begins
    double top_m = std::numeric_limits<double>::infinity();     // where the next one begins
};

// Finds the shell: the lowest large horizontal plane is the floor (on a scan of a table top, the
// table takes its place), and so are galleries and platforms of four square metres; large planes
// that have the whole scene on one side are walls or ceiling, and so are walls with something
// behind them (geometry/walls.h). A scene without such planes has no shell. Of each storey, where
// some are given, the floor is what lies at its height; ceilings look down from at least two metres
// above it; and walls, whatever lies behind them, are the large upright planes that end at the
// ceiling, or where none was seen, those two metres high; with what else lies in their planes, and
// with all that reaches up to the ceiling.
std::vector<Structure> find_structure(const Surfels& surfels, const PrimitiveSet& primitives,
                                      const Vec3& up, std::span<const StoreyHint> storeys = {});

// Noise leaves scraps of a wall floating within a few cells of it. A small primitive that lies in
// the plane of a shell primitive, as far as the resolution tells, or in the corner of two, joins
// it. Primitives keep their order and are numbered anew; `structure` with them.
void absorb_into_shell(const Surfels& surfels, PrimitiveSet& primitives,
                       std::vector<Structure>& structure);

}  // namespace topple::geometry
