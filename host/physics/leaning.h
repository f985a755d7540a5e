// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "core/cell_columns.h"
#include "physics/hidden_walls.h"
#include "physics/landscape.h"

namespace topple::physics {

// The same body beside what does not give way: a wall of the building, say, stops what would fall
// that way (sweep_over_edge), and leaves it to lean there. Then the edge that it goes over first
// releases what it has come down until there, nothing where it leans before it is over the edge,
// and what lies beyond that way is out of reach. Barriers stay as they are. Nothing where nothing
// stops it.
//   walls   of the building, where nobody saw them
//   fixed   by primitive, whether it does not give way
//   top_m   of the body, grid frame
//   open    with exact passes, whose ways are known
std::optional<Stability> beside_fixed(const SolidCells& cells, const CellColumns& columns,
                                      const HiddenWalls& walls, const Candidate& body,
                                      const std::vector<bool>& fixed, double top_m,
                                      const Stability& open);

// How far the footing reaches from under the centre of mass: to the line across the way that a body
// turns over.
double footing_reach(const Candidate& candidate, const Vec3& way);

}  // namespace topple::physics
