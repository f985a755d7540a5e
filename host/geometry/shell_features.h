// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/primitive_shapes.h"
#include "geometry/sight_lines.h"

namespace topple::geometry {

// What tells a primitive of the room itself (floor, walls, ceiling, what is built in) from a thing
// in it, as numbers that change little with the density of the scan: extent, orientation, what lies
// behind and before it, where in the scene it is. Lengths are metres or shares of the scene's. The
// names are those of the fitted model (fitted/).
std::span<const std::string_view> shell_feature_names();

// Row after row, one for each primitive, in the order of the names.
std::vector<float> shell_features(const SurfaceSamples& samples, const PrimitiveShapes& shapes,
                                  const SightLines& lines, ThreadPool& threads);

}  // namespace topple::geometry
