// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vectors.h"
#include "physics/landscape.h"

// The hull behind a HullLandscape, and the steepest ways over it. For this folder.
//
// Directions n here point down, n = -d, so that h(n) = max v.n. The cell of a corner a, where
// h = a.n, is { n : (a - w).n >= 0 for every neighbour w }. Within it the steepest way up leads
// along a great circle to a, the steepest way down away from it; both are straight lines s + t a
// and s - t a of unnormalised directions. All questions come down to the signs of two numbers per
// edge and side, each computed once: whether the foot of the centre of mass lies beyond an end of
// the edge, and whether a face's foot lies beyond the edge.
namespace topple::physics {

struct HullPolytope {
    struct Face {
        Vec3 normal{};  // outwards, unit
        double height = 0;
        std::vector<std::uint32_t> edges;
        bool minimum = false;
    };
    struct Edge {
        std::array<std::uint32_t, 2> end{};   // corners
        std::array<std::uint32_t, 2> face{};  // face[0] has the ends in this order
        // Of the foot of the centre of mass on the edge's line: how far inside of each end it
        // lies, times the edge's length; the two add up to the length squared.
        std::array<double, 2> inside{};
        // How far the foot of the centre of mass on each face lies inside of the edge.
        std::array<double, 2> margin{};
        Vec3 foot{};
        bool turns() const { return margin[0] > 0 && margin[1] > 0; }  // foot's n is on the arc
        bool held() const { return inside[0] >= 0 && inside[1] >= 0; }
        bool pass() const { return turns() && held(); }
        double highest = 0;  // of h on the arc
    };
    double radius = 0;                               // metres; all other lengths are in its units
    std::vector<Vec3> points;                        // as given, relative to the centre of mass
    std::vector<Vec3> corner;                        // relative to the centre of mass
    std::vector<std::uint32_t> point;                // number of the point of each corner
    std::vector<std::vector<std::uint32_t>> beside;  // edges at each corner
    std::vector<Face> face;
    std::vector<Edge> edge;
};

inline constexpr double hull_flat = 1e-9;  // of the extent: what spans less spans nothing

// Throws Error(input) as hull_landscape does.
HullPolytope hull_polytope(std::span<const Vec3> points, const Vec3& center_of_mass);

// Of the landscape. Nodes are the faces, then the edges; resolution is in units of the radius.
MergeTree merge_tree(const HullPolytope& hull, double resolution);

// The face that is a minimum and at the end of the steepest way down from the given one.
std::uint32_t descend(const HullPolytope& hull, std::uint32_t face);

// The same from any direction, as a unit vector that points down.
std::uint32_t descend(const HullPolytope& hull, const Vec3& down);

// The way down from both sides of a pass divides at it; this is the border between the two, from
// the top beyond the edge's first end over the pass to that beyond its second: unit vectors that
// point down, each joined to the next by an arc of a great circle.
std::vector<Vec3> border_over(const HullPolytope& hull, const HullPolytope::Edge& pass);

// Solid angle of the basin of steepest descent of each minimum, by face; 0 for other faces. The
// borders of basins are the steepest ways up from the passes, which are arcs of great circles; the
// angle within is their sum of signed triangles with the minimum (by Stokes' theorem).
std::vector<double> basin_angles(const HullPolytope& hull);

}  // namespace topple::physics
