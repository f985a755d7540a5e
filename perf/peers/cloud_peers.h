// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "perf/peers/script.h"
#include "topple/cloud_view.h"

namespace topple::perf {

// What Python's libraries make of a cloud, of those that the python3 of PATH has: normals of 30
// neighbours by Open3D and small_gicp, and Open3D's planar patches, as cloud_peers.py says.
struct CloudPeer : Told {
    std::vector<std::int32_t> label;  // of each point, where it finds segments
};
std::vector<CloudPeer> cloud_peers(const CloudView& cloud);

}  // namespace topple::perf
