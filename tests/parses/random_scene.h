// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"
#include "topple/parse.h"

// Clouds and options by chance, for parses that nobody thought of.
namespace topple::parses {

struct RandomScene {
    PointCloud cloud;
    ParseOptions options;
};

// Of a seed always the same. Most are a few solids on a floor, small and sparse so that a parse
// takes milliseconds; the others are what no scanner delivers: points in one place or on a line,
// far apart, doubled, with wrong normals, on no floor. One option in three is out of its default,
// one in thirty out of its range. `small`: of fewer and larger pieces, in voxels of 7 to 20 cm,
// and most are what a depth camera sees of boxes, so that many more can be tried.
RandomScene random_scene(std::uint64_t seed, bool small = false);

}  // namespace topple::parses
