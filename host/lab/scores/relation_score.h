// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lab/scores/share.h"
#include "lab/solids/scene.h"
#include "topple/scene.h"

namespace topple::scenes {

// Joints and supports, part by part. Parts with fewer than 60 points were not seen and don't count.
struct RelationScore {
    // Of true joints, those whose parts came out as one object; of touching parts in one object,
    // those truly joined, directly or not.
    Share fixed_recall, fixed_precision;
    // Of true supports, those found between the parts' objects; of found ones, those between
    // objects of which one truly carries the other.
    Share support_recall, support_precision;
};

// The body of each part: its object, where objects that are fixed to one another are one. What
// hangs on a wall is the room's.
std::vector<std::int32_t> true_bodies(const World& truth);

// part: the true part of each of the parse's points, -1 for none.
RelationScore relation_score(const World& truth, const Scene& parse,
                             std::span<const std::int32_t> part);

}  // namespace topple::scenes
