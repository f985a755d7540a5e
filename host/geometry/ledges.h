// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ledge.h"
#include "geometry/segmentation.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// Where upright sides step in or out by a part of a cell at one height all around: there one solid
// ends and another, of a slightly other size or place, stands on it, as in a stack of books. Smooth
// regions grow over such a step, for it is below what noise may be.

// The surest ledge of a solid that has sides like a box, or none. members: its surfels. up: unit.
// The height is along up, from the origin, metres.
std::optional<double> find_ledge(const Surfels& surfels, std::span<const std::uint32_t> members,
                                 const Eigen::Vector3d& up);

// Those between primitives that were cut (merge_convex()), sorted by `above`.
std::vector<Ledge> ledges_between(const Surfels& surfels, const PrimitiveSet& primitives,
                                  const Vec3& up);

}  // namespace topple::geometry
