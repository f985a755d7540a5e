// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/solid_scene.h"
#include "geometry/manhattan.h"
#include "topple/corrections.h"

namespace topple {

// The parts that a correction is about: those of the solid voxels nearest to its spots.
struct LocatedCorrection {
    std::vector<std::int32_t> at, from;  // primitives, ascending, each once
    std::string missed;  // of the spots near which nothing is solid, in words; "": of none
};

// How far from a solid voxel's middle a spot may be: what noise, other voxels and another scan's
// poses come to, and not as far as from one thing to the next.
double reach_m(double voxel_m);

std::vector<LocatedCorrection> locate(std::span<const Correction> corrections,
                                      const SolidScene& solids, const geometry::SceneFrame& frame);

}  // namespace topple
