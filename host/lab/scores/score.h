// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lab/scores/relation_score.h"
#include "lab/scores/segmentation_score.h"
#include "lab/scores/volume_score.h"
#include "lab/solids/scene.h"
#include "topple/scene.h"

// How well a parse found what is really there.
namespace topple::scenes {

// The true part of each point: the one whose surface is nearest, within 5 cm; else -1.
std::vector<std::int32_t> true_parts(const World& truth, const ScenePoints& points);

// The object of each part's point in `part`; -1 stays.
std::vector<std::int32_t> true_objects(const World& truth, const std::vector<std::int32_t>& part);

// All measures of a labelling of a parse's points; the cut discrepancy in cells of 2 cm.
SegmentationScore segmentation_score(const ScenePoints& points, std::span<const std::int32_t> truth,
                                     std::span<const std::int32_t> predicted);

// Angle between the found and the true up.
double gravity_error_deg(const World& truth, const Scene& parse);

struct Score {
    SegmentationScore parts;    // primitives against parts
    SegmentationScore objects;  // objects against objects
    VolumeScore volume;
    RelationScore relations;
    double gravity_deg = 0;
};

// Object 0 of the truth is the room. Uses all cores; the result does not depend on how many there
// are. Throws Error(input) where the parse has no points or no voxel size.
Score score(const World& truth, const Scene& parse);

}  // namespace topple::scenes
