// SPDX-License-Identifier: MIT
#pragma once

#include "lab/rooms/composer.h"

// What stands in a room of each family of make_world().
namespace topple::scenes {

void furnish_kitchen(Composer& room);
void furnish_bathroom(Composer& room);
void furnish_bedroom(Composer& room);
void furnish_living_room(Composer& room);
void furnish_office(Composer& room);
void furnish_corridor(Composer& room);
void furnish_shop(Composer& room);
void furnish_storage(Composer& room);
void furnish_precarious(Composer& room);
void furnish_tabletop(Composer& room);
void furnish_library(Composer& room);
void furnish_meeting(Composer& room);
void furnish_lounge(Composer& room);
void furnish_laundry(Composer& room);
void furnish_depot(Composer& room);

// Gives every part a colour that things of its name have: mostly one for equal parts of an object,
// often one for all of it; neighbours are alike by chance.
void paint(World& world, Random random);

}  // namespace topple::scenes
