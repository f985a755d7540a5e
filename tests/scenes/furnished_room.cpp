// SPDX-License-Identifier: MIT
#include "scenes/furnished_room.h"

#include <cmath>
#include <string>

#include "scenes/room_plans.h"
#include "topple/error.h"

namespace topple::scenes {

std::array<double, 2> free_middle(const World& world) {
    return {0.17 * world.room[0], 0.15 * world.room[1]};
}

World furnished_room(const RoomOptions& options) {
    if (!(options.clutter >= 0 && options.clutter <= 10) || !std::isfinite(options.tilt_deg)) {
        throw Error(ErrorKind::usage, "room: clutter is " + std::to_string(options.clutter) +
                                          " and must be 0 to 10; the tilt must be finite");
    }
    return options.varied ? varied_room(options) : plain_room(options);
}

}  // namespace topple::scenes
