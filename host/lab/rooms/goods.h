// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "lab/furniture/things.h"
#include "lab/rooms/composer.h"

// Goods where many are kept, and what lies about.
namespace topple::scenes {

// Layers of equal cartons on a placed pallet: flush, as one load, or loose.
void load_pallet(Composer& room, std::size_t index);

// Rows of furniture back to back with aisles of that width (metres) between them, so many goods
// per m^2 of shelf.
void aisles(Composer& room, double aisle, Blueprint (*make)(Random&), double clutter,
            Stack (*goods)(Random&, double));

// So many bags, boxes, bins and heaps anywhere on the floor.
void leave_on_floor(Composer& room, int count);

}  // namespace topple::scenes
