// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numbers>

#include "lab/furniture/things.h"
#include "lab/furniture/varied.h"
#include "lab/rooms/furnish.h"
#include "lab/rooms/goods.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

// A row of books on each shelf that has none yet, from its middle to one end or all along it.
void shelve_books(Composer& room, std::size_t index, const BookcaseMake& make) {
    Random& random = room.random();
    const Composer::Placed at = room.placed()[index];
    for (const Surface& s : at.blueprint.surfaces) {
        if (s.where != "shelf" || random.chance(0.06)) continue;
        const double length = 2 * s.half_x * std::clamp(make.full + 0.1, 0.4, 1.0) - 0.002;
        const Blueprint books = make_books(random, length, s.clearance, 2 * s.half_y, make.flush);
        const double out = random.chance(0.5) ? -1 : 1;
        const bool behind = make.two_sided && s.y < 0;
        const Part& board = at.blueprint.parts[s.part];
        const Pose pose{s.x + out * (s.half_x - length / 2 - 0.001), s.y, board.top(),
                        behind ? pi : 0};
        room.stand(books, moved(at.pose, pose), {at.first_part + s.part}, "shelf");
    }
}

void line_walls(Composer& room, const BookcaseMake& make) {
    Random& random = room.random();
    BookcaseMake one = make;
    one.two_sided = false;
    for (const int wall : room.walls()) {
        if (random.chance(0.25)) continue;
        const double length = room.wall_length(wall);
        const double from = random.chance(0.5) ? room.skirting() + 0.001 : random(0.3, 2);
        if (random.chance(0.3)) one.height = std::min(make.height, random(1.2, 2.4));
        const auto row = room.row(wall, from, length * random(0.6, 1), 0.2,
                                  [&] { return make_case_of_books(random, one); });
        for (const std::size_t index : row) shelve_books(room, index, one);
    }
}

// Rows of cases across the room, end to end.
void stand_in_rows(Composer& room, const BookcaseMake& make) {
    Random& random = room.random();
    const double aisle = random(0.9, 1.9), deep = (make.two_sided ? 2 : 1) * make.depth;
    const bool turned = random.chance(0.5);
    const Vec3& size = room.world().room;
    const double across = size[turned ? 0 : 1], along = size[turned ? 1 : 0];
    const double skew = random.chance(0.15) ? random(-0.1, 0.1) : 0;
    const double first = random(0.6, 1.5), last = along - random(0.6, 2.5);
    for (double y = aisle + 0.6; y < across - aisle - 0.4; y += aisle + deep) {
        if (random.chance(0.1)) continue;
        for (double x = first + make.width / 2; x < last - make.width / 2;
             x += make.width + (random.chance(0.85) ? 0.0004 : random(0.01, 0.7))) {
            const double flip = make.two_sided || random.chance(0.8) ? 0 : pi;
            const Pose pose{turned ? y : x, turned ? x : y, 0, (turned ? pi / 2 : 0) + flip + skew};
            if (room.stand(make_case_of_books(random, make), pose, {0}, "floor"))
                shelve_books(room, room.last(), make);
        }
    }
}

Stack reading(Random& random, double clearance) {
    return random.chance(0.6) ? make_shelf_item(random, std::min(clearance, 0.35))
                              : make_desk_item(random, clearance);
}

void place_tables(Composer& room) {
    Random& random = room.random();
    const Blueprint chair =
        random.chance(0.5) ? make_stacking_chair(random) : make_rail_chair(random);
    for (int k = random.integer(0, 4); k > 0; --k) {
        const bool show = random.chance(0.4);
        if (!room.anywhere(random.chance(0.8) ? make_work_table(random) : make_drum_table(random)))
            continue;
        const std::size_t table = room.last();
        for (int c = show ? 0 : random.integer(1, 6); c > 0; --c)
            room.before(table, random.integer(0, 3), chair);
        room.fill(table, show ? 7 : 2, reading);
    }
    if (!random.chance(0.7)) return;
    if (random.chance(0.5) ? room.anywhere(make_service_desk(random))
                           : room.along_wall(make_service_desk(random))) {
        const std::size_t desk = room.last();
        room.before(desk, 0, make_office_chair(random));
        room.fill(desk, 4, make_desk_item);
    }
}

}  // namespace

void furnish_library(Composer& room) {
    Random& random = room.random();
    const BookcaseMake make = any_bookcase_make(random, room.world().room[2] - 0.1);
    if (random.chance(0.85)) line_walls(room, make);
    if (random.chance(0.75))
        stand_in_rows(room, random.chance(0.6)
                                ? make
                                : any_bookcase_make(random, room.world().room[2] - 0.1));
    place_tables(room);
    for (int k = random.integer(0, 2); k > 0; --k)
        room.anywhere(random.chance(0.5) ? make_bolster_armchair(random) : make_ottoman(random));
    leave_on_floor(room, random.integer(0, 4));
    if (random.chance(0.4)) room.along_wall(make_bush(random, random(0.7, 1.4)));
    if (random.chance(0.3)) room.anywhere(make_step_ladder(random));
}

}  // namespace topple::scenes
