// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <numbers>

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

// Equal tables in columns and rows, joined or with aisles; where they stand in placed().
std::vector<std::size_t> join_tables(Composer& room, const Blueprint& table) {
    Random& random = room.random();
    const auto box = table.bounds();
    const double w = box[1][0] - box[0][0], d = box[1][1] - box[0][1];
    const Vec3& size = room.world().room;
    const bool joined = random.chance(0.6), turned = random.chance(0.5);
    const double along = size[turned ? 1 : 0] - 1.4, across = size[turned ? 0 : 1] - 1.4;
    const double step = joined ? d + 0.0004 : d + random(0.7, 1.2);
    const double next = random.chance(0.7) ? w + 0.0004 : w + random(0.02, 0.8);
    const int nx = std::clamp(static_cast<int>(along / next), 1, random.integer(1, 5)),
              ny = std::clamp(static_cast<int>(across / step), 1, joined ? 2 : 5);
    const double yaw = (turned ? pi / 2 : 0) + (random.chance(0.2) ? random(-0.3, 0.3) : 0);
    const Pose middle{size[0] * random(0.42, 0.58), size[1] * random(0.42, 0.58), 0, yaw};
    std::vector<std::size_t> found;
    for (int k = 0; k < nx * ny; ++k) {
        const double x = (k % nx - (nx - 1) / 2.0) * next, y = (k / nx - (ny - 1) / 2.0) * step;
        const bool about = joined && k / nx == 0 && ny == 2;  // they face one another
        const Pose pose = moved(middle, Pose{x, y, 0, about ? pi : 0});
        if (room.stand(table, pose, {0}, "floor")) found.push_back(room.last());
    }
    return found;
}

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

Blueprint pallet_rack(Random& random) {
    return make_rack(random, 4);
}

// Loaded pallets side by side on the floor.
void rows_of_pallets(Composer& room) {
    Random& random = room.random();
    const Vec3& size = room.world().room;
    const Blueprint pallet = make_pallet(random);
    const auto box = pallet.bounds();
    const double w = box[1][0] - box[0][0], d = box[1][1] - box[0][1];
    const int nx = random.integer(1, 5), ny = random.integer(1, 3);
    const double between = random.chance(0.5) ? 0.001 : random(0.01, 0.4);
    const Pose corner{random(0.2, 0.6) * size[0], random(0.1, 0.7) * size[1], 0,
                      random.chance(0.6) ? random.integer(0, 3) * pi / 2 : random(-pi, pi)};
    for (int k = 0; k < nx * ny; ++k) {
        if (random.chance(0.15)) continue;
        const Pose pose = moved(corner, Pose{(k % nx) * (w + between), (k / nx) * (d + between)});
        if (room.stand(pallet, pose, {0}, "floor") && random.chance(0.85))
            load_pallet(room, room.last());
    }
}

// Cartons of one size, side by side and on one another.
void stack_cartons(Composer& room) {
    Random& random = room.random();
    const Vec3 size{random(0.2, 0.7), random(0.2, 0.6), random(0.15, 0.6)};
    const Blueprint carton = lone_box("carton", "box", size);
    const Vec3& hall = room.world().room;
    const Pose corner{random(0.5, hall[0] - 1), random(0.5, hall[1] - 1), 0,
                      random.chance(0.5) ? 0 : random(-pi, pi)};
    const double between = random.chance(0.5) ? 0.0004 : random(0.002, 0.05);
    const int columns = random.integer(1, 5), layers = random.integer(1, 4);
    for (int k = 0; k < columns; ++k) {
        std::int32_t below = 0;
        for (int layer = 0; layer < layers; ++layer) {
            const Pose pose =
                moved(corner, Pose{k * (size[0] + between), random(-0.02, 0.02), layer * size[2],
                                   random.chance(0.6) ? 0 : random(-0.1, 0.1)});
            if (!room.stand(carton, pose, {below}, layer == 0 ? "floor" : "stack")) break;
            below = room.placed().back().first_part;
            if (random.chance(0.2)) break;
        }
    }
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
            const Pose pose = moved(at.pose, Pose{x, random(-0.1, 0.1)});
            if (unit.height() < 0.62) room.stand(unit, pose, {0}, "floor");
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
        const Blueprint shelves =
            random.chance(0.8) ? make_bookcase(random, 2.4) : make_free_cupboard(random);
        room.fill_if(room.along_wall(shelves), goods, make_shop_item);
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

void furnish_meeting(Composer& room) {
    Random& random = room.random();
    for (int k = random.integer(0, 3); k > 0; --k)
        room.on_wall(make_wall_board(random, random(0.8, 3.0)), random(0.7, 1.0));
    if (random.chance(0.4))
        room.on_wall(make_projection_screen(random, random(1.2, 2.2)), random(0.6, 0.9));
    const auto tables = join_tables(room, make_work_table(random));
    const Blueprint chair = random.chance(0.4)   ? make_office_chair(random)
                            : random.chance(0.6) ? make_stacking_chair(random)
                                                 : make_rail_chair(random);
    const double seats = random(1, 4), clutter = random(0, 5);
    for (const std::size_t table : tables) {
        for (int k = static_cast<int>(seats * random(0.4, 1.4)); k > 0; --k)
            room.before(table, random.chance(0.8) ? random.integer(0, 1) : random.integer(2, 3),
                        chair);
        room.fill(table, clutter, make_desk_item);
    }
    if (random.chance(0.4) && !room.walls().empty())  // spare chairs along a wall
        room.row(room.any_wall(), random(0.1, 1), random(2, 4), 0.7, [&] { return chair; });
    if (random.chance(0.4)) room.anywhere(make_lectern(random));
    if (random.chance(0.4)) room.anywhere(make_board_on_wheels(random));
    for (int k = random.integer(0, 3); k > 0; --k) {
        const Blueprint low =
            random.chance(0.5) ? make_free_cupboard(random) : make_drawer_unit(random);
        if (room.along_wall(low)) room.fill(room.last(), 4, make_shelf_item);
    }
    leave_on_floor(room, random.integer(0, 5));
    for (int k = random.integer(0, 6); k > 0; --k) room.anywhere(chair);
}

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

void furnish_depot(Composer& room) {
    Random& random = room.random();
    const Vec3& size = room.world().room;
    for (int k = random.integer(0, 4); k > 0; --k) {
        const double thick = random(0.2, 0.5);
        room.add_building_box("pillar", random(0.2, 0.8) * size[0], random(0.2, 0.8) * size[1], 0,
                              {thick, thick, size[2]});
    }
    const double goods = random(1, 4);
    for (int k = random.integer(0, 4); k > 0; --k)
        room.fill_if(room.along_wall(make_rack(random, room.world().room[2] - 0.3)), goods,
                     make_store_item);
    if (random.chance(0.4)) aisles(room, random(1.4, 2.6), pallet_rack, goods, make_store_item);
    for (int k = random.integer(1, 3); k > 0; --k) rows_of_pallets(room);
    for (int k = random.integer(1, 6); k > 0; --k) stack_cartons(room);
    for (int k = random.integer(0, 3); k > 0; --k) room.anywhere(make_drum(random));
    if (random.chance(0.6)) room.anywhere(make_pallet_jack(random));
    if (random.chance(0.5)) room.fill_if(room.anywhere(make_trolley(random)), 4, make_store_item);
    for (int k = random.integer(0, 4); k > 0; --k) room.anywhere(make_carton(random, 0.8));
}

}  // namespace topple::scenes
