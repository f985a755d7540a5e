// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "lab/furniture/things.h"
#include "lab/furniture/varied.h"
#include "lab/rooms/furnish.h"
#include "lab/rooms/goods.h"

namespace topple::scenes {

void furnish_lounge(Composer& room) {
    Random& random = room.random();
    const Vec3& size = room.world().room;
    if (random.chance(0.5))
        room.add_building_box(
            "carpet", size[0] * random(0.35, 0.65), size[1] * random(0.35, 0.65), -0.0001,
            {random(0.2, 0.6) * size[0], random(0.2, 0.6) * size[1], random(0.004, 0.014)});
    for (int k = random.integer(0, 2); k > 0; --k)
        room.on_wall(
            make_wall_curtain(random, random(0.4, 2.2), std::min(size[2] - 0.05, random(2.0, 2.6))),
            0);
    if (random.chance(0.5)) room.along_wall(make_corner_sofa(random));
    if (random.chance(0.6)) {  // side by side
        const Blueprint like = make_couch(random);
        const bool equal = random.chance(0.6);
        const double from = random(0.05, 1);
        room.row(room.any_wall(), from, from + random(2, 5), 0.5,
                 [&] { return equal ? like : make_couch(random); });
    }
    const std::size_t seats = room.placed().size();
    for (int k = random.integer(0, 4); k > 0; --k)
        room.anywhere(
            one_of(random, {make_bolster_armchair, make_ottoman, make_corner_sofa, make_couch}));
    for (std::size_t k = 0; k < seats; ++k) {  // low tables before them
        if (!random.chance(0.4)) continue;
        room.before(k, 0, random.chance(0.5) ? make_ottoman(random) : make_drum_table(random));
    }
    for (int k = random.integer(0, 3); k > 0; --k)
        room.anywhere(random.chance(0.5) ? make_drum_table(random) : make_pedestal_table(random));
    if (random.chance(0.6) && room.along_wall(make_tv_board(random))) {
        const std::size_t board = room.last();
        room.on_surface(board, room.placed()[board].blueprint.surfaces.back(),
                        {make_television(random)});
    }
    if (random.chance(0.3)) {
        if (room.along_wall(random.chance(0.5) ? make_soft_bed(random) : make_double_bed(random)))
            room.along_wall(make_drawer_unit(random));
    }
    for (int k = random.integer(0, 2); k > 0; --k) room.along_wall(make_bookcase(random, 2.2));
    for (int k = random.integer(0, 3); k > 0; --k)
        room.along_wall(make_bush(random, random(0.6, 1.6)));
    for (int k = random.integer(0, 2); k > 0; --k) room.along_wall(make_lamp_on_pole(random));
    const double clutter = random(1, 9);
    const std::size_t count = room.placed().size();
    for (std::size_t k = 0; k < count; ++k) {
        const bool soft = room.placed()[k].blueprint.name == "sofa";
        room.fill(k, soft ? 2.5 : clutter, soft ? make_soft_item : make_home_item);
    }
    leave_on_floor(room, random.integer(0, 5));
}

}  // namespace topple::scenes
