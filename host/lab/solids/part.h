// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "lab/solids/bounds.h"
#include "lab/solids/solids.h"
#include "topple/input.h"

namespace topple::scenes {

enum class Shape {
    box,             // size: full sides
    rounded_box,     // the same, with Part::rounding
    cylinder,        // axis z; size: diameter, diameter, height
    lying_cylinder,  // axis x; size: length, diameter, diameter
    sphere,          // size: diameter three times
    cone,            // axis z; size: diameter of the base, the same, height; see Part::top_ratio
    revolved,        // Part::profile about z; size: of its bounding box
};
const char* to_string(Shape shape);

// How a front of furniture opens: about the edge at its own lowest or highest x, or about its lower
// one; or it is drawn out, towards its own +y.
enum class Opening : std::uint8_t { none, hinge_at_low_x, hinge_at_high_x, hinge_below, slide };

inline Opening hinge_at(double side) {
    return side < 0 ? Opening::hinge_at_low_x : Opening::hinge_at_high_x;
}

// One solid whose every measure is known exactly. All but `revolved` are convex. Metres, radians,
// room frame.
struct Part {
    Shape shape = Shape::box;
    Vec3 center{};         // middle of its bounding box along its own axes
    Vec3 size{};           // along its own axes
    double yaw = 0;        // about z, after `lean`
    double top_ratio = 0;  // cones only: diameter at the top over that of the base; 0 is pointed
    std::int32_t object = -1;
    std::string name;
    double lean = 0;            // about its own x: its top goes to -y; not for lying cylinders
    double rounding = 0;        // rounded boxes only: radius of all edges and corners
    solids::Profile profile{};  // revolved ones only: about the center
    std::array<std::uint8_t, 3> colour{200, 200, 200};  // red, green, blue in white light
    Opening opening = Opening::none;

    double volume() const;                 // closed form
    Vec3 center_of_mass() const;           // closed form, room frame
    double distance(const Vec3& p) const;  // exact signed distance, negative inside
    // The same with the turn worked out beforehand: for loops over many points.
    struct Heading {
        double cosine, sine, lean_cosine, lean_sine;
    };
    Heading heading() const;
    double distance(const Vec3& p, const Heading& heading) const;
    bool inside(const Vec3& p) const { return distance(p) <= 0; }
    // Outward unit gradient of distance(); where it is not unique, one of its limits.
    Vec3 normal(const Vec3& p) const;
    // Distance along origin + t * direction (unit) to the first hit with t > 0, or infinity. From
    // inside it is the way out.
    double hit(const Vec3& origin, const Vec3& direction) const {
        return hit(origin, direction, heading());
    }
    double hit(const Vec3& origin, const Vec3& direction, const Heading& heading) const;
    // Its own axes as unit vectors of the room's frame; bodies of revolution turn about the third.
    std::array<Vec3, 3> axes() const;
    // Of those: corners (r, z) about their axis, from below to above; of cones and cylinders the
    // rims alone.
    solids::Profile outline() const;
    double bounding_radius() const;  // about center
    Bounds bounds() const;           // axis-aligned in the room's frame: lowest, highest corner
    double bottom() const { return bounds()[0][2]; }
    double top() const { return bounds()[1][2]; }
    Part hull() const;  // the part itself, or a concave one's convex hull
};

// Twice the least value that max(distance to a, distance to b) takes, up to `tolerance`: the gap
// between the hulls of two parts, or, where negative, how deep one reaches into the other.
double gap(const Part& a, const Part& b, double tolerance = 1e-4);

}  // namespace topple::scenes
