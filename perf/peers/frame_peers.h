// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "perf/peers/script.h"
#include "topple/input.h"

namespace topple::perf {

// What Python's libraries take for depth frames, of those that the python3 of PATH has: free space
// by VDBFusion and DUFOMap, and Open3D's surfaces, as frame_peers.py says.
std::vector<Told> frame_peers(const Intrinsics& intrinsics, std::span<const DepthFrame> frames,
                              double voxel_m);

}  // namespace topple::perf
