// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/manhattan.h"
#include "geometry/segmentation.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// The part that a primitive plays in the room's shell.
enum class Structure : std::uint8_t { none, floor, wall, ceiling };

// Finds the shell: the lowest large horizontal plane is the floor (on a scan of a table top, the
// table takes its place), and so are galleries and platforms of four square metres; large planes
// that have the whole scene on one side are walls or ceiling. A scene without such planes has no
// shell.
std::vector<Structure> find_structure(const Surfels& surfels, const PrimitiveSet& primitives,
                                      const Vec3& up);

// Noise leaves scraps of a wall floating within a few cells of it. A small primitive that lies in
// the plane of a shell primitive, as far as the resolution tells, or in the corner of two, joins
// it. Primitives keep their order and are numbered anew; `structure` with them.
void absorb_into_shell(const Surfels& surfels, PrimitiveSet& primitives,
                       std::vector<Structure>& structure);

}  // namespace topple::geometry
