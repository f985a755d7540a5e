// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "export/body.h"

namespace topple::exports {

// Of a side that something can stand on.
inline constexpr double carries_cosine = 0.8;

// How two parts lie to one another, along the face of either that tells them apart best.
struct Apart {
    Vec3 normal{};     // unit, from the first to the second
    double gap_m = 0;  // below 0: so deep do they overlap, at most
};
Apart apart(const ConvexPart& a, const ConvexPart& b);

// How deep they overlap; 0 where that is a micrometre at most, or edges tell them apart.
double overlap_m(const ConvexPart& a, const ConvexPart& b);
inline bool overlap(const ConvexPart& a, const ConvexPart& b) {
    return overlap_m(a, b) > 0;
}

// The box around parts.
Extents<double> box_around(std::span<const ConvexPart> parts);

// Whether two boxes come closer than that.
bool near(const Extents<double>& a, const Extents<double>& b, double distance_m);

// Whether any part of the bodies that comes so near to a box is so: is(body, part).
template <class Is>
bool any_near(const std::vector<Body>& bodies, const Extents<double>& to, double distance_m,
              const Is& is) {
    return std::ranges::any_of(bodies, [&](const Body& body) {
        return std::ranges::any_of(body.parts, [&](const ConvexPart& part) {
            return near(to, part, distance_m) && is(body, part);
        });
    });
}

// Whether a part lies in any body but one.
bool meets(const std::vector<Body>& bodies, const ConvexPart& part, const Body& but);

// Cuts parts of different bodies where they overlap, along the plane between them that takes least
// of what is solid; what lies below keeps its form where either would do. A body that cutting would
// leave with nothing keeps what it has.
void separate(std::vector<Body>& bodies);

// Opens a gap, much less than what one sees, between the sides of bodies that touch without one
// carrying the other: each contact costs a simulator time.
void clear_sides(std::vector<Body>& bodies);
// The same below a body, which has feet to stand on.
void clear_below(const std::vector<Body>& bodies, Body& body);

// The deepest overlap of any two bodies, metres.
double deepest_overlap_m(const std::vector<Body>& bodies);

}  // namespace topple::exports
