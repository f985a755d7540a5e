// SPDX-License-Identifier: MIT
#include "lab/rooms/furnished_room.h"

#include <cmath>
#include <string>

#include "lab/rooms/furnisher.h"
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
    if (options.size &&
        !((*options.size)[0] >= 2 && (*options.size)[1] >= 2 && (*options.size)[2] >= 2 &&
          (*options.size)[0] <= 100 && (*options.size)[1] <= 100 && (*options.size)[2] <= 10)) {
        throw Error(ErrorKind::usage,
                    "room: its size must be 2 to 100 m by 2 to 100 m, and 2 to 10 m high");
    }
    return options.varied ? varied_room(options) : plain_room(options);
}

}  // namespace topple::scenes
