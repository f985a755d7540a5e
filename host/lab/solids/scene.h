// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "lab/solids/part.h"
#include "topple/input.h"

// Scenes whose every solid is known exactly. The room's frame: metres, z up, floor at z = 0.
namespace topple::scenes {

struct TrueObject {
    std::string name;
    std::string where;  // "room" | "floor" | "wall" | "table-edge" | "table-middle" | "shelf" | ...
    bool pile = false;  // loose things that its truth does not tell apart, such as goods in a row
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
