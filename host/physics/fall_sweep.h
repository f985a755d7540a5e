// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/cell_columns.h"
#include "physics/hidden_walls.h"
#include "physics/landscape.h"

namespace topple::physics {

// Where a body's centre of mass comes to lie when it turns over an edge, grid frame: on its side,
// the edge below, unless its front, from the height of the centre up, meets solid of others before,
// which it then leans on.
struct Swept {
    Vec3 center{};
    bool stopped = false;
    std::int32_t by = -1;  // the primitive that stopped it
};
// support_m: the height of what carries it; direction: horizontal, unit; beside_m: how far the edge
// is from the centre of mass that way; top_m: the body's highest point. A twentieth of the front
// must meet something; what reaches less than two voxels above the support is no stop. Walls that
// go on behind what hides them stop it, too. along: primitives that go with it, sorted. stops: by
// primitive, which of the others do; empty: all do.
Swept sweep_over_edge(const SolidCells& cells, const CellColumns& columns, const HiddenWalls& walls,
                      const Candidate& body, std::span<const std::int32_t> along, double support_m,
                      const Vec3& direction, double beside_m, double top_m,
                      const std::vector<bool>& stops = {});

}  // namespace topple::physics
