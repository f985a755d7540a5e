// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "perf/kernels/measure.h"
#include "perf/standing_objects.h"

// Pose landscapes as grouping and the barriers of objects use them, host and kernels together.
namespace topple::perf {

// The names below, in their order.
std::vector<std::string> landscape_names();

// "landscapes/table": support functions of 96 primitives of 128 vertices in 2562 directions.
// "landscapes/groups": from those, landscapes and barriers of 1,000 groups of up to 8 primitives.
// "landscapes/hulls": the exact landscapes of 100 hulls of 50 points, on the host alone.
// "landscapes/objects": S(W) of 24 objects that stand on tables and floors, in one batch.
std::vector<Result> measure_landscapes(device::Device& device, unsigned runs);

// The points of the hulls, about their centres of mass, and the objects.
std::vector<std::vector<Vec3>> hull_points();
std::vector<simulation::StandingObject> standing_things();

}  // namespace topple::perf
