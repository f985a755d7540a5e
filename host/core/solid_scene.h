// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/boundary_cells.h"
#include "core/cell_columns.h"
#include "core/role.h"
#include "core/solid_cells.h"

namespace topple {

// The solids of a scene, made once after completion and never changed: what physics, graph, safety
// and outputs read. Grid frame.
class SolidScene {
  public:
    // cells: sorted by (i, j, k). roles: by primitive. strays: cells far from all others, sorted;
    // they are solid, but no primitive's, and in nobody's way. boundary: what bounds the solids
    // within voxels; none: all cells are solid as wholes. Throws Error(usage) for what is not
    // sorted, whose arrays differ in length, whose primitive has no role, or that refers to what is
    // not there: nothing is made of the parts before that. What comes from a file is more
    // (core/saved_solids.h).
    SolidScene(SolidCells cells, std::vector<Role> roles, SolidCells strays = {},
               BoundaryCells boundary = {});

    double voxel_m() const { return cells_.voxel_m; }
    const SolidCells& cells() const { return cells_; }
    const SolidCells& strays() const { return strays_; }
    const BoundaryCells& boundary() const { return boundary_; }
    const CellColumns& columns() const { return columns_; }
    std::size_t primitives() const { return roles_.size(); }
    const std::vector<Role>& roles() const { return roles_; }  // by primitive
    Role role(std::int32_t primitive) const { return role_of(roles_, primitive); }
    std::vector<bool> shell() const { return shell_of(roles_); }  // by primitive
    // Of cell n.
    double probability(std::size_t n) const { return probability_solid(cells_.basis[n]); }
    // Cells and strays, sorted: what outputs show.
    SolidCells with_strays() const;

  private:
    SolidCells cells_, strays_;
    BoundaryCells boundary_;
    CellColumns columns_;
    std::vector<Role> roles_;
};

}  // namespace topple
