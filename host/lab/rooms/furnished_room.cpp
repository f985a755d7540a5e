// SPDX-License-Identifier: MIT
#include "lab/rooms/furnished_room.h"

#include <cmath>

#include "lab/rooms/furnisher.h"
#include "topple/error.h"

namespace topple::scenes {

std::array<double, 2> free_middle(const World& world) {
    return {0.17 * world.room[0], 0.15 * world.room[1]};
}

World furnished_room(const RoomOptions& options) {
    if (!std::isfinite(options.tilt_deg))
        throw Error(ErrorKind::usage, "room: the tilt must be finite");
    return options.varied ? varied_room(options) : plain_room(options);
}

}  // namespace topple::scenes
