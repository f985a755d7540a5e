// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/surfels.h"

namespace topple::geometry {

// The surfels' colours, from those of their points, where the cloud has any: see Surfels::lab_l.
void set_colours(const CloudView& cloud, Surfels& surfels);

}  // namespace topple::geometry
