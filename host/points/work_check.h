// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "geometry/framed_surfels.h"
#include "points/budget.h"
#include "points/observation.h"
#include "points/parse_memory.h"
#include "topple/parse.h"

namespace topple {

// Throws Error(input) of a parse in one piece that is sure to take more memory than its budget,
// with the voxels that would do. Else says so where it takes long.
void check_work(const std::string& source, const OnePiece& piece, double voxel_m, Budget& budget);

// The same of points whose surface alone takes too much, before anything is made of them. pitch_m:
// how far apart they are. The input's resolution is known.
void check_surface(const Observation& input, double pitch_m, const ParseOptions& options,
                   Budget& budget);

// The same of what solids are about to be made of. The cloud has a point or more.
void check_work(const Observation& input, const FramedSurfels& surfels, double voxel_m,
                Budget& budget);

// Throws Error(input) of a cloud that may need more than ParseOptions::max_memory_bytes.
void check_memory_of(const Observation& input, double voxel_m, const ParseOptions& options);

// Throws Error(input) of a scan in which no surface was found. source: as the message names it.
[[noreturn]] void fail_without_surface(const Observation& input, const std::string& source,
                                       double extent_m);

}  // namespace topple
