// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "perf/kernels/measure.h"

namespace topple::perf {

// The hulls of "landscapes/hulls" by compute_stable_poses of trimesh, if the python3 of PATH has
// it. Prints both beside each other, or that it is missing.
std::optional<Result> compare_with_trimesh(const std::vector<Result>& own);

// The objects of "landscapes/objects" toppled by blows in Bullet, if the build has it. Prints both
// beside each other, or that it is missing.
std::optional<Result> compare_with_bullet(const std::vector<Result>& own);

}  // namespace topple::perf
