// SPDX-License-Identifier: MIT
#include <array>
#include <numbers>
#include <utility>

#include "lab/furniture/things.h"
#include "lab/furniture/varied.h"
#include "lab/rooms/furnish.h"
#include "lab/rooms/goods.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

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

void furnish_office(Composer& room) {
    Random& random = room.random();
    const double clutter = random(2, 11);
    for (int k = random.integer(1, 5); k > 0; --k) {
        const Blueprint desk = make_work_table(random);
        const bool found = random.chance(0.65) ? room.along_wall(desk) : room.anywhere(desk);
        if (!found) continue;
        const std::size_t table = room.last();
        work_seats(room, table, random.integer(0, 2));
        if (random.chance(0.5)) {  // a drawer unit under it
            const Blueprint unit = make_drawer_unit(random);
            const Composer::Placed at = room.placed()[table];
            const auto box = desk.bounds();
            const double x = random(0.5, 0.8) * box[random.chance(0.5) ? 0 : 1][0];
            const Vec3 p = moved(at.pose, Vec3{x, random(-0.1, 0.1), 0});
            if (unit.height() < 0.62) room.stand(unit, {p[0], p[1], 0, at.pose.yaw}, {0}, "floor");
        }
        room.fill(table, clutter, make_desk_item);
    }
    for (int k = random.integer(0, 3); k > 0; --k)
        room.fill_if(room.along_wall(make_bookcase(random, 2.2)), 5, make_shelf_item);
    for (int k = random.integer(0, 2); k > 0; --k)
        room.fill_if(room.along_wall(make_drawer_unit(random)), clutter, make_desk_item);
    if (random.chance(0.4)) room.along_wall(make_bush(random, random(0.8, 1.5)));
    if (random.chance(0.3)) room.along_wall(make_coat_stand(random));
    for (int k = random.integer(0, 3); k > 0; --k) room.along_wall(make_basket(random));
    for (int k = random.integer(0, 4); k > 0; --k) {
        const Stack stack = make_store_item(random, 0.8);
        if (!stack.empty()) room.anywhere(stack.front());
    }
}

void furnish_corridor(Composer& room) {
    Random& random = room.random();
    const double width = room.world().room[1];
    for (int k = random.integer(2, 7); k > 0; --k) {
        constexpr auto bush = [](Random& r) { return make_bush(r, r(0.5, 1.0)); };
        constexpr auto carton = [](Random& r) { return make_carton(r, 0.6); };
        constexpr std::array<BlueprintMake, 6> others{
            make_drawer_unit, make_rail_chair, make_bench, bush, make_basket, carton};
        Blueprint thing = make_bookcase(random, 1.6);
        const std::size_t which = random.index(others.size() + 1);
        if (which < others.size()) thing = others[which](random);
        const auto box = thing.bounds();
        if (box[1][1] - box[0][1] > width - 0.55) continue;
        if (room.along_wall(thing)) room.fill(room.last(), random(1, 6), make_shelf_item);
    }
    for (int k = random.integer(0, 2); k > 0; --k) {
        const WallThing thing = make_wall_thing(random);
        room.on_wall(thing.blueprint, random(thing.lowest, thing.highest));
    }
    if (random.chance(0.4)) room.leaning(make_leaning_thing(random));
}

void furnish_shop(Composer& room) {
    Random& random = room.random();
    const double goods = random(2, 8);
    for (int k = random.integer(3, 9); k > 0; --k) {
        const bool done = random.chance(0.8) ? room.along_wall(make_bookcase(random, 2.4))
                                             : room.along_wall(make_free_cupboard(random));
        if (done) room.fill(room.last(), goods, make_shop_item);
    }
    if (random.chance(0.7)) aisles(room, random(0.9, 1.4), make_gondola, goods, make_shop_item);
    for (int k = random.integer(1, 4); k > 0; --k) {
        if (!room.anywhere(make_work_table(random))) continue;
        const std::size_t table = room.last();
        room.fill(table, goods, make_shop_item);
        if (random.chance(0.5)) work_seats(room, table, random.integer(1, 3));
    }
    if (random.chance(0.6)) {
        const Blueprint counter = make_counter(random, random(1.2, 2.5));
        const Vec3& size = room.world().room;
        if (room.fix(counter, {random(1.5, size[0] - 1.5), random(1.5, size[1] - 1.5), 0,
                               random.integer(0, 3) * pi / 2}))
            room.fill(room.last(), goods, make_desk_item);
    }
    for (int k = random.integer(0, 4); k > 0; --k) room.anywhere(make_splayed_stool(random));
    for (int k = random.integer(0, 2); k > 0; --k) room.along_wall(make_bush(random, 1.2));
    if (random.chance(0.4)) room.anywhere(make_basket(random));
}

void furnish_storage(Composer& room) {
    Random& random = room.random();
    const bool hall = room.world().room[2] > 3;
    const double goods = random(1.5, 5);
    for (int k = random.integer(1, hall ? 6 : 3); k > 0; --k)
        room.fill_if(room.along_wall(make_rack(random, room.world().room[2] - 0.3)), goods,
                     make_store_item);
    if (hall && random.chance(0.5)) aisles(room, random(1.2, 2), any_rack, goods, make_store_item);
    for (int k = random.integer(0, hall ? 7 : 2); k > 0; --k) {
        if (room.anywhere(make_pallet(random)) && random.chance(0.8))
            load_pallet(room, room.last());
    }
    if (random.chance(0.5))
        room.fill_if(room.along_wall(make_work_table(random)), 5, make_store_item);
    for (int k = random.integer(2, 10); k > 0; --k) {
        const int what = random.integer(0, 6);
        constexpr std::array<BlueprintMake, 4> makes{make_step_ladder, make_bucket, make_drum,
                                                     make_trolley};
        if (what < 4) {
            const bool done = room.anywhere(makes[what](random));
            if (done && what == 3) room.fill(room.last(), 4, make_store_item);
            continue;
        }
        if (what == 4) {
            room.leaning(make_leaning_thing(random));
            continue;
        }
        const Blueprint below = make_carton(random, 0.7);
        if (!(random.chance(0.6) ? room.along_wall(below) : room.anywhere(below))) continue;
        if (below.parts.size() > 2) continue;
        Blueprint crowded = below;
        crowded.stand_on(0, 1.2, "carton", 0);
        const std::size_t index = room.last();
        room.on_surface(index, crowded.surfaces.front(), make_store_item(random, 1.2));
    }
}

}  // namespace topple::scenes
