// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "perf/measure.h"

// Pose landscapes as grouping and the barriers of objects use them, host and kernels together.
namespace topple::perf {

// The names below, in their order.
std::vector<std::string> landscape_names();

// "landscapes/table": support functions of 96 primitives of 128 vertices in 2562 directions.
// "landscapes/groups": from those, landscapes and barriers of 1,000 groups of up to 8 primitives.
// "landscapes/hulls": the exact landscapes of 100 hulls of 50 points, on the host alone.
// "landscapes/objects": S(W) of 24 objects that stand on tables and floors, in one batch.
std::vector<Result> measure_landscapes(device::Device& device, unsigned runs);

// The same hulls by compute_stable_poses of trimesh, if the python3 of PATH has it. Prints both
// beside each other, or that it is missing.
std::optional<Result> compare_with_trimesh(const std::vector<Result>& own);

// The same objects toppled by blows in Bullet, if the build has it. Prints both beside each other,
// or that it is missing.
std::optional<Result> compare_with_bullet(const std::vector<Result>& own);

}  // namespace topple::perf
