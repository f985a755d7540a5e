// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/object_of.h"
#include "core/table.h"
#include "graph/joints.h"
#include "graph/known_links.h"

namespace topple::graph {

// Of an object the likeliest larger one that it is a piece of, half of a desk, say, or a shelf of a
// cupboard, though grouping left them apart. A smaller one would change little of what is said of
// it.
struct PieceOf {
    double probability = 0;
    std::int32_t primitive = -1;  // the other's, of the likeliest joint between both
};

// Of an object the joint that it hangs together by: of all where two larger parts of it meet, the
// least likely. That it is several things in one is as likely as that this joint is none.
struct WeakestJoint {
    double probability = 1;       // that it is one
    std::int32_t a = -1, b = -1;  // its primitives; -1 where all of it is one part

    bool doubtful() const;
};

// Below this an object is about as likely two: in six scans of others' worlds five of seven were,
// of the other 206 15 % held another thing of a seventh of it or more.
inline constexpr double doubtful_joint = 0.6;

// Of an object no part that holds less of the seen surface is asked for.
inline constexpr double least_part = 0.05;

// surface: voxels in which it was seen. Parts grow by the likeliest joints first (single linkage),
// so that each pair of parts is judged by its likeliest. What is known to be one object is one
// part.
Table<ObjectId, WeakestJoint> weakest_joints(std::span<const Joint> joints, const KnownLinks& links,
                                             ObjectOf object_of,
                                             TableView<PrimitiveId, std::uint64_t> surface,
                                             std::size_t objects);

// An object's primitives, ascending, on both sides of that joint: all others are joined, the
// likeliest first, as long as that leaves its ends apart. What no joint reaches is with the first.
std::vector<std::vector<std::int32_t>> both_sides(std::span<const Joint> joints,
                                                  const KnownLinks& links,
                                                  std::span<const std::int32_t> primitives,
                                                  const WeakestJoint& joint);

// surface: the same of objects; those of none are nobody's whole, as the ground, which is no thing.
// Objects known to be one, or none, are no question.
Table<ObjectId, PieceOf> likely_pieces(std::span<const Joint> joints, const KnownLinks& links,
                                       ObjectOf object_of,
                                       TableView<ObjectId, std::uint64_t> surface);

// That an object is one thing and all of it. voxels: as of physics::MassProperties, which the
// model was fitted on.
double whole_probability(const PieceOf& piece, const WeakestJoint& weakest, std::uint64_t voxels);

}  // namespace topple::graph
