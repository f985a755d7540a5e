// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "geometry/segmentation.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// Primitives of fewer than `least_surfels` surfels may be noise: of such a fragment most lies in
// the faces of the solids around it. Each of these joins the primitive that it shares the most
// border with, fragments of fragments included; one that touches nothing larger and has fewer
// surfels than a region is unassigned (-1). What stands off those faces is a small thing and stays,
// and what stands off all solids together, as the pieces of a thin leg do, becomes one primitive.
// Surfels without a primitive then join what surrounds them, so that no unlabelled crust parts a
// leg from its table: only those that touch nothing stay -1. Primitives keep their order and are
// numbered anew.
void absorb_fragments(const Surfels& surfels, std::uint64_t least_surfels,
                      PrimitiveSet& primitives);

}  // namespace topple::geometry
