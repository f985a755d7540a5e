// SPDX-License-Identifier: MIT
#include "perf/peers/pcl_segmentation.h"

// Stands for pcl_segmentation.cpp where the build found no PCL.
namespace topple::perf {

std::optional<PeerSegments> pcl_region_growing(const CloudView&) {
    return std::nullopt;
}
std::optional<PeerSegments> pcl_lccp(const CloudView&) {
    return std::nullopt;
}

}  // namespace topple::perf
