// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "lab/solids/solids.h"

// Outlines of what is turned on a lathe or a potter's wheel. A side runs from the lowest point of
// the outside to the highest, as points (r, z) with z from 0 upwards.
namespace topple::scenes {

using Side = solids::Profile;

// All that is within the side.
solids::Profile solid_within(const Side& side);

// Open at the top: walls as thick as `wall` (measured level) on a floor as thick as `floor`. The
// side rises and is wider than `wall` everywhere.
solids::Profile vessel_within(const Side& side, double wall, double floor);

// A smooth side through radii at equal steps of height (Catmull-Rom).
Side smooth_side(const std::vector<double>& radii, double height);

// A quarter of an ellipse from (r, z) to (r + dr, z + dz). It sets out upright, or, with `level`,
// outwards; without its first point. For shoulders, domes and bowls.
Side quarter(double r, double z, double dr, double dz, bool level);

Side joined(Side first, const Side& second);

}  // namespace topple::scenes
