// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lab/solids/scene.h"

namespace topple::scenes {

struct RoomOptions {
    std::uint64_t seed = 1;
    double tilt_deg = 0;  // turns the input's frame against the room's, about a random axis
    double clutter = 1;   // scales the number of small things; 0: furniture only
    // Turned, hollow, rounded, splayed, leaning and piled things, levels and a ceiling, instead of
    // the plain furniture.
    bool varied = false;
    std::optional<Vec3> size{};  // inner width, depth and height; by chance where not given
    // Boxes (lowest, highest corner) that nothing but a rug reaches into, such as ways to doors.
    std::vector<std::array<Vec3, 2>> keep_free{};
};

// A furnished room: floor, walls, perhaps a pillar; furniture along the walls and what stands on
// it, with a free middle (half extents free_middle() of the room's) where at most a rug lies.
// Solids never overlap, and different objects touch only where one carries the other, is fixed to a
// wall or leans against it. The same options give the same room everywhere.
World furnished_room(const RoomOptions& options);

// Half extents of the middle of the room that stays free, metres.
std::array<double, 2> free_middle(const World& world);

}  // namespace topple::scenes
