// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numbers>
#include <utility>

#include "lab/furniture/things.h"
#include "lab/furniture/varied.h"
#include "lab/rooms/composer.h"
#include "lab/rooms/goods.h"
#include "lab/rooms/plans.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

Composer::Make things_of(Random& random, Stack (*make)(Random&, double)) {
    return [&random, make](double clearance) { return make(random, clearance); };
}

// Chairs that swivel before tables, stools in between.
void work_seats(Composer& room, std::size_t table, int count) {
    Random& random = room.random();
    for (int k = 0; k < count; ++k) {
        const Blueprint chair = random.chance(0.65)  ? make_office_chair(random)
                                : random.chance(0.6) ? make_rail_chair(random)
                                                     : make_splayed_stool(random);
        room.before(table, random.integer(0, 1), chair);
    }
}

Blueprint any_rack(Random& random) {
    return make_rack(random, 3.0);
}

}  // namespace

World make_office(std::uint64_t seed) {
    Composer room(seed, 205);
    Random& random = room.random();
    Composer::Shell shell;
    shell.size = {random.uniform(2.6, 7), random.uniform(2.6, 5.5), random.uniform(2.4, 3.0)};
    room.build(shell);
    const double clutter = random.uniform(2, 11);
    for (int k = random.integer(1, 5); k > 0; --k) {
        const Blueprint desk = make_work_table(random);
        const bool found = random.chance(0.65) ? room.along_wall(desk) : room.anywhere(desk);
        if (!found) continue;
        const std::size_t table = room.placed().size() - 1;
        work_seats(room, table, random.integer(0, 2));
        if (random.chance(0.5)) {  // a drawer unit under it
            const Blueprint unit = make_drawer_unit(random);
            const Composer::Placed at = room.placed()[table];
            const auto box = desk.bounds();
            const double x = random.uniform(0.5, 0.8) * box[random.chance(0.5) ? 0 : 1][0];
            const Vec3 p = moved(at.pose, Vec3{x, random.uniform(-0.1, 0.1), 0});
            if (unit.height() < 0.62) room.stand(unit, {p[0], p[1], 0, at.pose.yaw}, {0}, "floor");
        }
        room.fill(table, clutter, things_of(random, make_desk_item));
    }
    for (int k = random.integer(0, 3); k > 0; --k) {
        if (room.along_wall(make_bookcase(random, 2.2)))
            room.fill(room.placed().size() - 1, 5, things_of(random, make_shelf_item));
    }
    for (int k = random.integer(0, 2); k > 0; --k) {
        if (room.along_wall(make_drawer_unit(random)))
            room.fill(room.placed().size() - 1, clutter, things_of(random, make_desk_item));
    }
    if (random.chance(0.4)) room.along_wall(make_bush(random, random.uniform(0.8, 1.5)));
    if (random.chance(0.3)) room.along_wall(make_coat_stand(random));
    for (int k = random.integer(0, 3); k > 0; --k) room.along_wall(make_basket(random));
    for (int k = random.integer(0, 4); k > 0; --k) {
        const Stack stack = make_store_item(random, 0.8);
        if (!stack.empty()) room.anywhere(stack.front());
    }
    return std::move(room.world());
}

World make_corridor(std::uint64_t seed) {
    Composer room(seed, 206);
    Random& random = room.random();
    Composer::Shell shell;
    shell.size = {random.uniform(3.5, 9), random.uniform(0.95, 1.7), random.uniform(2.2, 2.8)};
    shell.missing = 0.1;
    shell.doors = 4;
    room.build(shell);
    const double width = shell.size[1];
    for (int k = random.integer(2, 7); k > 0; --k) {
        Blueprint thing = make_bookcase(random, 1.6);
        switch (random.integer(0, 6)) {
            case 0:
                thing = make_drawer_unit(random);
                break;
            case 1:
                thing = make_rail_chair(random);
                break;
            case 2:
                thing = make_bench(random);
                break;
            case 3:
                thing = make_bush(random, random.uniform(0.5, 1.0));
                break;
            case 4:
                thing = make_basket(random);
                break;
            case 5:
                thing = make_carton(random, 0.6);
                break;
            default:
                break;
        }
        const auto box = thing.bounds();
        if (box[1][1] - box[0][1] > width - 0.55) continue;
        if (room.along_wall(thing))
            room.fill(room.placed().size() - 1, random.uniform(1, 6),
                      things_of(random, make_shelf_item));
    }
    for (int k = random.integer(0, 2); k > 0; --k) {
        const WallThing thing = make_wall_thing(random);
        room.on_wall(thing.blueprint, random.uniform(thing.lowest, thing.highest));
    }
    if (random.chance(0.4)) room.leaning(make_leaning_thing(random));
    return std::move(room.world());
}

World make_shop(std::uint64_t seed) {
    Composer room(seed, 207);
    Random& random = room.random();
    Composer::Shell shell;
    shell.size = {random.uniform(4.5, 9), random.uniform(4, 8), random.uniform(2.5, 3.6)};
    room.build(shell);
    const double goods = random.uniform(2, 8);
    for (int k = random.integer(3, 9); k > 0; --k) {
        const bool done = random.chance(0.8) ? room.along_wall(make_bookcase(random, 2.4))
                                             : room.along_wall(make_free_cupboard(random));
        if (done) room.fill(room.placed().size() - 1, goods, things_of(random, make_shop_item));
    }
    if (random.chance(0.7))
        aisles(room, random.uniform(0.9, 1.4), make_gondola, goods, make_shop_item);
    for (int k = random.integer(1, 4); k > 0; --k) {
        if (!room.anywhere(make_work_table(random))) continue;
        const std::size_t table = room.placed().size() - 1;
        room.fill(table, goods, things_of(random, make_shop_item));
        if (random.chance(0.5)) work_seats(room, table, random.integer(1, 3));
    }
    if (random.chance(0.6)) {
        const Blueprint counter = make_counter(random, random.uniform(1.2, 2.5));
        const Vec3& size = room.world().room;
        if (room.fix(counter,
                     {random.uniform(1.5, size[0] - 1.5), random.uniform(1.5, size[1] - 1.5), 0,
                      random.integer(0, 3) * pi / 2}))
            room.fill(room.placed().size() - 1, goods, things_of(random, make_desk_item));
    }
    for (int k = random.integer(0, 4); k > 0; --k) room.anywhere(make_splayed_stool(random));
    for (int k = random.integer(0, 2); k > 0; --k) room.along_wall(make_bush(random, 1.2));
    if (random.chance(0.4)) room.anywhere(make_basket(random));
    return std::move(room.world());
}

World make_storage(std::uint64_t seed) {
    Composer room(seed, 208);
    Random& random = room.random();
    const bool hall = random.chance(0.5);
    Composer::Shell shell;
    shell.size = {random.uniform(3, hall ? 11 : 5), random.uniform(2.5, hall ? 9 : 4.5),
                  hall ? random.uniform(3.2, 6) : random.uniform(2.3, 2.9)};
    shell.ceiling = hall ? 0.2 : 0.5;
    room.build(shell);
    const double goods = random.uniform(1.5, 5);
    for (int k = random.integer(1, hall ? 6 : 3); k > 0; --k) {
        if (room.along_wall(make_rack(random, shell.size[2] - 0.3)))
            room.fill(room.placed().size() - 1, goods, things_of(random, make_store_item));
    }
    if (hall && random.chance(0.5))
        aisles(room, random.uniform(1.2, 2), any_rack, goods, make_store_item);
    for (int k = random.integer(0, hall ? 7 : 2); k > 0; --k) {
        if (room.anywhere(make_pallet(random)) && random.chance(0.8))
            load_pallet(room, room.placed().size() - 1);
    }
    if (random.chance(0.5) && room.along_wall(make_work_table(random)))
        room.fill(room.placed().size() - 1, 5, things_of(random, make_store_item));
    for (int k = random.integer(2, 10); k > 0; --k) {
        switch (random.integer(0, 6)) {
            case 0:
                room.anywhere(make_step_ladder(random));
                break;
            case 1:
                room.anywhere(make_bucket(random));
                break;
            case 2:
                room.anywhere(make_drum(random));
                break;
            case 3:
                if (room.anywhere(make_trolley(random)))
                    room.fill(room.placed().size() - 1, 4, things_of(random, make_store_item));
                break;
            case 4:
                room.leaning(make_leaning_thing(random));
                break;
            default: {
                const Blueprint below = make_carton(random, 0.7);
                if (!(random.chance(0.6) ? room.along_wall(below) : room.anywhere(below))) break;
                if (below.parts.size() > 2) break;
                Blueprint crowded = below;
                crowded.stand_on(0, 1.2, "carton", 0);
                const std::size_t index = room.placed().size() - 1;
                room.on_surface(index, crowded.surfaces.front(), make_store_item(random, 1.2));
            }
        }
    }
    return std::move(room.world());
}

}  // namespace topple::scenes
