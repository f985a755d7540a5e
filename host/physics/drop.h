// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/cell_columns.h"
#include "core/unseen.h"
#include "physics/landscape.h"

namespace topple::physics {

// How far a body that tips over an edge of its support falls below the height of it, metres: to the
// highest surface that is none of its own where it lands. 0 where the support goes on, or may do so
// unseen, or where nothing is known of what lies there. One value for each edge of footing(), in
// their order; where the centre of mass is outside, one for the way in which it falls. The body has
// a support polygon.
std::vector<double> drops_when_tipped_m(const SolidCells& cells, const CellColumns& columns,
                                        const Candidate& body, const Unseen& unseen = {});
// The primitive that it falls onto in a horizontal direction over an edge of its support, of which
// `on_edge` is a point, and it is known to fall; -1 for other solid.
std::int32_t met_when_tipped(const SolidCells& cells, const CellColumns& columns,
                             const Candidate& body, const Vec3& direction, const Vec3& on_edge);

}  // namespace topple::physics
