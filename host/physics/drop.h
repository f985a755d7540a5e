// SPDX-License-Identifier: MIT
#pragma once

#include "physics/cell_columns.h"
#include "physics/landscape.h"

namespace topple::physics {

// How far a body that tips over the weakest edge of its support falls below the height of it,
// metres: to the highest surface that is none of its own where it lands. 0 where the support goes
// on, or where nothing is known of what lies there. The body has a support polygon.
double drop_when_tipped_m(const SolidCells& cells, const CellColumns& columns,
                          const Candidate& body);

}  // namespace topple::physics
