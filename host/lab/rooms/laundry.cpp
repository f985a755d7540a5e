// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "lab/furniture/things.h"
#include "lab/furniture/varied.h"
#include "lab/rooms/furnish.h"

namespace topple::scenes {
namespace {

// Equal appliances side by side, another on some, or a worktop fixed close above them.
void line_up(Composer& room, int wall) {
    Random& random = room.random();
    const Vec3 size{random(0.55, 0.75), random(0.55, 0.8), random(0.82, 1.1)};
    const double length = room.wall_length(wall);
    const double from = random.chance(0.5) ? room.skirting() + 0.002 : random(0.1, 0.9);
    const double to = std::min(length, from + random(0.8, 6));
    const auto row = room.row(wall, from, to, 0.4, [&] { return make_washer(random, size); });
    const bool stacked = random.chance(0.35);
    for (const std::size_t index : row) {
        const Composer::Placed below = room.placed()[index];
        if (!stacked || random.chance(0.2)) continue;
        room.stand(make_washer(random, size), {below.pose.x, below.pose.y, size[2], below.pose.yaw},
                   {below.first_part}, "appliance");
    }
    if (stacked || row.empty() || random.chance(0.5)) return;
    Blueprint top("worktop");
    const double wide = to - from;
    top.box("worktop", 0, 0, 0, {wide, size[1] + 0.1, random(0.025, 0.05)});
    room.fix(top, room.against_wall(wall, from + wide / 2, -top.back(), size[2] + 0.21, 0));
}

Stack cloth_or_bottle(Random& random, double clearance) {
    return random.chance(0.4) ? make_soft_item(random, clearance)
                              : make_bath_item(random, clearance);
}

}  // namespace

void furnish_laundry(Composer& room) {
    Random& random = room.random();
    for (int k = random.integer(1, 3); k > 0; --k) line_up(room, room.any_wall());
    if (random.chance(0.5)) room.along_wall(make_counter(random, random(0.8, 2)), true);
    if (random.chance(0.5))
        room.on_wall(make_wall_cupboards(random, random(0.6, 2.4)), random(1.5, 1.7));
    if (random.chance(0.4)) room.anywhere(make_ironing_board(random));
    if (random.chance(0.4)) room.anywhere(make_drying_rack(random));
    for (int k = random.integer(0, 2); k > 0; --k)
        if (!room.anywhere(make_work_table(random))) break;
    for (int k = random.integer(0, 2); k > 0; --k) room.along_wall(make_free_cupboard(random));
    const Blueprint chair = make_stacking_chair(random);
    if (random.chance(0.3))
        room.row(room.any_wall(), random(0.1, 1), random(1.5, 3), 0.5, [&] { return chair; });
    const double clutter = random(0.5, 6);
    room.fill_all(clutter, cloth_or_bottle);
    for (int k = random.integer(1, 7); k > 0; --k) {
        const Stack stack = make_floor_thing(random, 1);
        if (!stack.empty() && !room.anywhere(stack.front())) room.along_wall(stack.front());
    }
}

}  // namespace topple::scenes
