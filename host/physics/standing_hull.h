// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "physics/hull_ways.h"
#include "physics/landscape.h"
#include "physics/support_rows.h"

// The one hull of a candidate on which it turns, for its barriers and for the landscape that is
// drawn.
namespace topple::physics {

// The vertices of all its primitives' hulls, relative to its centre of mass, grid frame.
std::vector<Vec3> vertices_of(const SupportTable::Rows& rows, const Candidate& candidate);

// Whether its centre of mass lies inside of what holds it up.
bool is_held(const Candidate& candidate);

// Of a body whose hull may seem to rock by what is not known of its contacts: by how much it may,
// if its footing holds it. Two voxels of height over the distance at which it does.
std::optional<double> dent_angle(const SupportTable::Rows& rows, const Candidate& candidate);
// Whether a descent to `bottom` (up there, unit) is within that.
bool is_dent(const SupportTable::Rows& rows, double angle, const Vec3& bottom, double depth_m);

// Where a candidate stood and its footing holds it, or its hull would fall though its footing holds
// it, the hull is cut at the height of the support and as wide there as the footing: what reaches
// lower is noise, or hangs beside the end of the support. Else it is that of its vertices.
// Nothing where these have no hull about the centre of mass. Its start is the pose as scanned, or
// the bottom of the dent that holds it.
std::shared_ptr<const HullWays> standing_hull(const SupportTable::Rows& rows,
                                              const Candidate& candidate);

}  // namespace topple::physics
