// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/primitive_shapes.h"

namespace topple::geometry {

// Whether a primitive is a box that stands by itself, as cabinets and crates do: all of it lies on
// the faces of one upright box no larger than furniture, of which its top and three sides or more
// were seen. A wall goes up to the ceiling or to where the scan ends, or on beyond the scan; a box
// whose top was seen from above, and that was walked around, does neither. floor_m: on what it
// stands, or a little above that.
bool is_upright_box(const SurfaceSamples& samples, const PrimitiveShape& shape, double floor_m);

}  // namespace topple::geometry
