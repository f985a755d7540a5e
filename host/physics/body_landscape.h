// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "physics/hull_landscape.h"
#include "physics/landscape.h"

// The pose landscape of a candidate, as its picture shows it.
namespace topple::physics {

// The vertices of all its primitives' hulls, relative to its centre of mass, grid frame.
std::vector<Vec3> vertices_of(const SupportTable::Rows& rows, const Candidate& candidate);

// Poses shallower than a voxel are parts of others, and passes are those between two poses. Its
// directions and corners are in the grid frame. No corners where the vertices have no hull about
// the centre of mass.
Landscape body_landscape(const SupportTable& table, const Candidate& candidate);

}  // namespace topple::physics
