// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "topple/cloud_view.h"

// What the Point Cloud Library makes of a cloud, for comparison. nullopt where the build found
// none.
namespace topple::perf {

struct PeerSegments {
    std::string name;
    std::string library;                   // its name and version
    double normals_s = 0, segments_s = 0;  // wall time
    std::vector<std::int32_t> label;       // of each point, -1 for none
};

// Normals of 30 neighbours (OpenMP, all cores), then RegionGrowing with the parameters of PCL's
// tutorial: 30 neighbours, 3 degrees, curvature below 1, 50 points at least.
std::optional<PeerSegments> pcl_region_growing(const CloudView& cloud);

// Supervoxels (voxels of 2 cm, seeds 12 cm apart), then LCCP (10 degrees, sanity check, segments of
// one supervoxel filtered). Supervoxels make their own normals: normals_s is 0.
std::optional<PeerSegments> pcl_lccp(const CloudView& cloud);

}  // namespace topple::perf
