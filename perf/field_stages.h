// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "perf/kernels/measure.h"
#include "perf/stage_cases.h"

// The disturbance fields of the stages' room, host and kernels together.
namespace topple::perf {

// The names below, in their order.
std::vector<std::string> field_names();

// "fields/human": 500 walks, map cells of 5 cm, 16 directions, 8 levels of energy. "fields/wind":
// gales from 16 directions. "fields/earthquake": 64 pulses. Bytes are those that dispatches bind,
// each input and output once.
std::vector<Result> measure_fields(device::Device& device, const StageScene& scene, unsigned runs);

}  // namespace topple::perf
