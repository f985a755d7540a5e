// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "topple/input.h"

// The pose landscape of a convex hull on a level plane, exactly: what landscape.h samples over a
// mesh of directions (paper, 3.1 and 3.2, Eq. 4, Defs. 1 and 2). Over the unit sphere of the body's
// up direction d, the height of its centre of mass above the plane,
//
//     h(d) = c.d - min over the points v of v.d = U(d) / (M g),
//
// is the maximum of one linear function for each corner of the hull. Its minima are the faces whose
// inside lies under the centre of mass, its passes are edges with the centre of mass above them,
// its maxima corners. Corners and edges divide the sphere as the hull's dual does: nodes are faces,
// arcs are edges. From anywhere one gets to an arc without climbing, so the merge tree of the
// sphere is that of the graph of nodes and arcs.
//
// All is in the points' own frame and unit, metres; times M g, heights are joules.
namespace topple::physics {

// A stable pose: one basin of the landscape.
struct HullPose {
    Vec3 up{};            // unit: up where it rests
    double height_m = 0;  // of the centre of mass above the plane
    // The least climb out of its basin (Def. 1); infinity where there is no other pose.
    double barrier_m = 0;
    // The disconnectivity graph: the height at which its basin joins that of a deeper pose, and
    // which one; infinity and -1 for the deepest of all.
    double joins_at_m = 0;
    std::int32_t joins = -1;
    // Chance that the body comes to rest in it if each orientation is as likely at first and it
    // turns the steepest way down, without momentum: the basin's solid angle over 4 pi.
    double probability = 0;
    // Distance of the point under the centre of mass from the border of the face.
    double margin_m = 0;
    std::vector<std::uint32_t> contacts;  // numbers of the points that touch the plane, ascending
};

// An edge of the hull over which the body can balance.
struct HullPass {
    Vec3 up{};  // unit
    double height_m = 0;
    std::array<std::uint32_t, 2> points{};  // numbers of the edge's ends
    // Where it comes to rest, to either side: numbers of poses, which may be the same one.
    std::array<std::int32_t, 2> poses{};
    // The border between both sides, from top to top: up directions, each joined to the next by an
    // arc of a great circle. Only where asked for.
    std::vector<Vec3> border{};
};

struct HullLandscape {
    std::vector<HullPose> poses;         // by rising height
    std::vector<HullPass> passes;        // by rising height
    std::size_t maxima = 0;              // corners on which it could balance
    double highest_m = 0;                // the top of the landscape
    std::vector<std::uint32_t> corners;  // numbers of the points that are corners of the hull
    // Where it is with HullOptions::up up: the pose that it comes to rest in, and its height now.
    std::int32_t now = 0;
    double now_m = 0;
};

struct HullOptions {
    // To which heights are known: a pose whose basin is no deeper is part of the one that it joins
    // (a lying cylinder of many facets is one pose), and a point no higher above the plane touches
    // it. It is never taken for less than 1e-12 and, for touching, 1e-9 of the hull's radius.
    double resolution_m = 0;
    Vec3 up{0, 0, 1};      // unit: up now
    bool borders = false;  // whether passes have theirs
};

// Points need not be corners and may repeat. Throws Error(input) for points that are fewer than
// four, not finite, or all in one point, line or plane (to 1e-9 of their extent), for a centre of
// mass that is not inside of their hull, and for a resolution that is no number from 0 on.
HullLandscape hull_landscape(std::span<const Vec3> points, const Vec3& center_of_mass,
                             const HullOptions& options = {});
// Of a hull that is there already.
struct HullPolytope;
HullLandscape hull_landscape(const HullPolytope& hull, const HullOptions& options);

}  // namespace topple::physics
