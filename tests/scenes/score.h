// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "scenes/scene.h"
#include "topple/scene.h"

// How well a parse found what is really there.
namespace topple::scenes {

// One labelling of points against another (Chen, Golovinskiy & Funkhouser 2009); negative
// predictions count as one segment of their own.
struct SegmentationScore {
    double hamming = 0;       // mean of the next two
    double missing = 0;       // share of points outside of their true segment's best match
    double false_alarm = 0;   // share of points outside of their predicted segment's best match
    double miou = 0;          // best intersection over union of each true segment, all alike
    double weighted_iou = 0;  // the same, weighted by points
    std::uint64_t segments = 0;
};
SegmentationScore segmentation_score(std::span<const std::int32_t> truth,
                                     std::span<const std::int32_t> predicted);

// A share, and of how many cases; NaN of none.
struct Share {
    double value = 0;
    std::uint64_t of = 0;
};

struct Score {
    SegmentationScore parts;    // primitives against parts
    SegmentationScore objects;  // objects against objects
    // Solid voxels against all parts but the room's: a voxel is right within 0.87 voxels (half a
    // diagonal) of a part; a true voxel, a quarter inside, is found where it or a face neighbour is
    // solid.
    Share volume_precision, volume_recall;
    // Of true joints, those whose parts came out as one object; of touching parts in one object,
    // those truly joined, directly or not.
    Share fixed_recall, fixed_precision;
    // Of true supports, those found between the parts' objects; of found ones, those between
    // objects of which one truly carries the other.
    Share support_recall, support_precision;
    double gravity_deg = 0;  // angle between the found and the true up
};

// The truth of a point is the part whose surface is nearest, within 5 cm. Parts with fewer than 60
// points were not seen and don't count among the relations. The room is object 0. Uses all cores;
// the result does not depend on how many there are. Throws Error(input) where the parse has no
// points or no voxel size.
Score score(const World& truth, const topple::Scene& parse);

}  // namespace topple::scenes
