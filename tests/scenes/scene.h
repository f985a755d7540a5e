// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "topple/input.h"

// Scenes whose every solid is known exactly. The room's frame: metres, z up, floor at z = 0.
namespace topple::scenes {

enum class Shape {
    box,             // size: full sides
    cylinder,        // axis z; size: diameter, diameter, height
    lying_cylinder,  // axis x; size: length, diameter, diameter
    sphere,          // size: diameter three times
    cone,            // axis z; size: diameter of the base, the same, height; see Part::top_ratio
};
const char* to_string(Shape shape);

// One convex solid.
struct Part {
    Shape shape = Shape::box;
    Vec3 center{};         // middle of its bounding box along its own axes
    Vec3 size{};           // along its own axes
    double yaw = 0;        // about z, radians
    double top_ratio = 0;  // cones only: diameter at the top over that of the base; 0 is pointed
    std::int32_t object = -1;
    std::string name;

    double volume() const;                 // closed form
    Vec3 center_of_mass() const;           // closed form, room frame
    double distance(const Vec3& p) const;  // exact signed distance, negative inside
    // The same with the heading worked out beforehand: for loops over many points.
    struct Heading {
        double cosine, sine;
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
    double bounding_radius() const;      // about center
    std::array<Vec3, 2> bounds() const;  // axis-aligned in the room's frame: lowest, highest corner
    double bottom() const { return center[2] - size[2] / 2; }
    double top() const { return center[2] + size[2] / 2; }
};

// Twice the least value that max(distance to a, distance to b) takes, up to `tolerance`: the gap
// between two convex parts, or, where negative, how deep one reaches into the other.
double gap(const Part& a, const Part& b, double tolerance = 1e-4);

struct TrueObject {
    std::string name;
    std::string where;  // "room" | "floor" | "wall" | "table-edge" | "table-middle" | "shelf" | ...
};

// Parts, the objects they form, what is fixed to what and what carries what. Ids are positions in
// the arrays. Object 0 is the room: floor and walls.
struct World {
    std::uint64_t seed = 0;
    Vec3 room{};  // inner width (x), depth (y), height (z)
    std::vector<Part> parts;
    std::vector<TrueObject> objects;
    std::vector<std::pair<std::int32_t, std::int32_t>> fixed;    // parts
    std::vector<std::pair<std::int32_t, std::int32_t>> support;  // parts: supporter, supported
    // p_input = tilt * p_room; row-major rotation. Everything that is written for the parser to
    // read (cloud, poses) is in the input's frame; the truth stays in the room's.
    std::array<double, 9> tilt{1, 0, 0, 0, 1, 0, 0, 0, 1};

    Vec3 to_input(const Vec3& p) const;
    Vec3 to_room(const Vec3& p) const;
    // Signed distance to the nearest part, and which one that is (the lowest of equals).
    std::pair<double, std::int32_t> distance(const Vec3& p) const;
};

// Rotation by `angle` radians about a unit axis, row-major (Rodrigues).
std::array<double, 9> rotation(const Vec3& axis, double angle);

}  // namespace topple::scenes
