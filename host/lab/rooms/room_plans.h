// SPDX-License-Identifier: MIT
#pragma once

#include "lab/rooms/furnished_room.h"

// What stands where, by chance: one plan for each kind of furnished room.
namespace topple::scenes {

World plain_room(const RoomOptions& options);
World varied_room(const RoomOptions& options);

}  // namespace topple::scenes
