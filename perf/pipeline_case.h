// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "lab/scores/score.h"
#include "perf/kernels/measure.h"

namespace topple::perf {

struct PipelineOptions {
    std::uint64_t seed = 1;
    unsigned frames = 40;
    unsigned runs = 3;
};

// The whole parse of a generated room, read from a sequence folder: one result for each stage,
// named "pipeline/<stage>", and "pipeline" for all; and "export", which makes a scene for
// simulators of the last one. The score of the last parse goes to `score`. The hash is of the
// labels of points and voxels, and of every object's barrier.
std::vector<Result> measure_pipeline(const std::shared_ptr<device::Device>& device,
                                     const PipelineOptions& options, scenes::Score& score);

}  // namespace topple::perf
