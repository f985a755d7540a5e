// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/surfels.h"
#include "topple/input.h"

namespace topple::geometry {

inline constexpr std::uint32_t no_eye = 0xffffffff;

struct VirtualViewOptions {
    std::vector<Vec3> known_eyes;  // where a sensor is known to have been
    // Of each surfel the known eye that it is said to have been seen from, or no_eye; or empty.
    std::vector<std::uint32_t> seen_from;
    // Places to look from: with the known ones, or where there are none in each 200 m^3.
    unsigned eyes = 12;
    bool sides_known = false;  // the surfels' normals point to the side that was free
    // Gaps of less than this radius between surfels are surface that was hit by no point; 0: those
    // alone that a surfel is wide.
    double gap_m = 0;
    // Called after each place that was looked from, with about how much is done, 0 to 1; or empty.
    std::function<void(double)> tell{};
};

// Depth images as a sensor would have taken them from free places of the scene.
struct VirtualViews {
    Intrinsics intrinsics;
    std::vector<DepthFrame> frames;
    std::vector<Vec3> eyes;
    // The eyes, and after them places right in front of surfels that no eye has in front: their
    // sides are known from what is around them.
    std::vector<Vec3> viewpoints;
    // Of the surfels that are said to have been seen from a known eye, those that something hides
    // from there.
    double hidden_share = 0;
    bool sides_believed = false;  // they were said to be known, and the first place bore it out
    // For each surfel a viewpoint in front of it; empty where no eye was found.
    std::vector<std::uint32_t> viewpoint_of_surfel;
};

// For a cloud without poses. The first place is the one with the most free space around it that
// sees much of the scene; the others are chosen among what the earlier ones saw to be free, inside
// of a room or around a single thing; then in closed rooms that none of them sees, and above what
// has no ceiling. What a place sees for the first time faces it; a surface that
// is later seen from behind ends no ray, since the way to it leads through what nobody scanned.
// Where sides are known, the first place must see most surfaces from the front; where none does,
// the sides are not believed.
VirtualViews virtual_views(const Surfels& surfels, const VirtualViewOptions& options,
                           ThreadPool& pool);

}  // namespace topple::geometry
