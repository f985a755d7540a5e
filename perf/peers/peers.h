// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "perf/kernels/measure.h"
#include "perf/stage_cases.h"

// The Point Cloud Library and OctoMap on the same data as the stages.
namespace topple::perf {

// Runs the peers that the build has once each, prints them beside topple's best times, says which
// are missing, and returns their results, named "<stage>/<peer>".
std::vector<Result> compare_with_peers(const StageScene& scene, const StageRun& own);

}  // namespace topple::perf
