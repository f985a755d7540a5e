// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numbers>

#include "lab/furniture/things.h"
#include "lab/furniture/varied.h"
#include "lab/rooms/furnish.h"
#include "lab/rooms/goods.h"

namespace topple::scenes {
namespace {

// Things per m^2 of surface: from tidy to crowded.
double any_clutter(Random& random) {
    return random(1, 4) * random(1, 4);
}

// Chairs around the last thing placed, some tucked under it.
void seat(Composer& room, std::size_t table, int chairs) {
    Random& random = room.random();
    const Blueprint one = make_rail_chair(random);
    for (int k = 0; k < chairs; ++k) {
        const Blueprint other = random.chance(0.2) ? make_splayed_chair(random) : one;
        room.before(table, random.integer(0, 3), other);
    }
}

void scatter_on_floor(Composer& room, int most, Stack (*make)(Random&, double)) {
    Random& random = room.random();
    for (int k = random.integer(0, most); k > 0; --k) {
        const Stack stack = make(random, 0.9);
        if (!stack.empty()) room.anywhere(stack.front(), 20);
    }
}

// A run of counter along a wall from its corner on, with free-standing things in gaps, and
// cupboards above. Returns where it ends.
double fitted_run(Composer& room, int wall, double from, double to) {
    Random& random = room.random();
    double at = from;
    while (at < to - 0.7) {
        if (random.chance(0.3)) {
            const Blueprint free =
                random.chance(0.4) ? make_fridge(random) : make_appliance(random);
            const auto box = free.bounds();
            const double w = box[1][0] - box[0][0];
            if (at + w > to) break;
            const double slack = random(0.001, 0.02);
            const Pose pose = room.against_wall(
                wall, at + slack + w / 2, room.skirting() + random(0, 0.04) - free.back(), 0, 0);
            at += room.stand(free, pose, {0}, "floor") ? w + 2 * slack : 0.3;
            continue;
        }
        const double length = std::min(to - at, random(0.6, 2.6));
        const Blueprint counter = make_counter(random, length);
        const bool done = room.fix(
            counter,
            room.against_wall(wall, at + length / 2, room.skirting() - counter.back(), 0, 0));
        if (done && random.chance(0.6)) {
            const double above = random(1.32, 1.55);
            if (random.chance(0.25) && length > 1) {
                room.fix(make_hood(random),
                         room.against_wall(wall, at + length / 2, 0, above + 0.1, 0));
            } else {
                const double wide = random(0.5, 1) * length;
                const Blueprint cupboards = make_wall_cupboards(random, wide);
                if (above + cupboards.height() < room.world().room[2])
                    room.fix(cupboards, room.against_wall(wall, at + wide / 2, 0, above, 0));
            }
        }
        at += done ? length : 0.3;
    }
    return at;
}

}  // namespace

void furnish_kitchen(Composer& room) {
    Random& random = room.random();
    const int wall = room.any_wall();
    const double length = room.wall_length(wall);
    fitted_run(room, wall, room.skirting() + (random.chance(0.6) ? 0.001 : random(0, 0.8)),
               length * random(0.55, 1.0));
    if (random.chance(0.5)) {
        const int next = room.any_wall();
        if (next != wall) fitted_run(room, next, 0.68, room.wall_length(next) * random(0.4, 1));
    }
    if (random.chance(0.3)) {  // an island
        const Blueprint island = make_counter(random, random(0.9, 1.8));
        const Vec3& size = room.world().room;
        room.fix(island, {size[0] * random(0.4, 0.6), size[1] * random(0.4, 0.6), 0,
                          random.integer(0, 3) * std::numbers::pi / 2});
    }
    for (int k = random.integer(0, 2); k > 0; --k) room.along_wall(make_free_cupboard(random));
    if (random.chance(0.5)) room.along_wall(make_fridge(random));
    if (random.chance(0.75)) {
        const Blueprint table =
            random.chance(0.8) ? make_work_table(random) : make_pedestal_table(random);
        if (random.chance(0.5) ? room.anywhere(table) : room.along_wall(table))
            seat(room, room.last(), random.integer(1, 5));
    }
    if (random.chance(0.3)) room.on_wall(make_wall_shelf(random), random(1.2, 1.6));
    room.fill_all(any_clutter(random), make_kitchen_item);
    if (random.chance(0.6)) room.along_wall(make_basket(random));
    scatter_on_floor(room, 3, make_home_item);
}

void furnish_bathroom(Composer& room) {
    Random& random = room.random();
    room.along_wall(make_bath(random), true);
    room.along_wall(make_toilet(random), true);
    for (int k = random.integer(1, 2); k > 0; --k) room.along_wall(make_basin(random), true);
    if (random.chance(0.6)) room.on_wall(make_towel_rail(random), random(1.0, 1.5));
    if (random.chance(0.6)) room.on_wall(make_wall_cupboards(random, random(0.4, 0.9)), 1.35);
    if (random.chance(0.7)) room.along_wall(make_bookcase(random, 1.8));
    if (random.chance(0.5)) room.along_wall(make_drawer_unit(random));
    if (random.chance(0.5)) room.along_wall(make_appliance(random));
    if (random.chance(0.4)) room.anywhere(make_splayed_stool(random));
    room.fill_all(any_clutter(random), make_bath_item);
    for (int k = random.integer(0, 2); k > 0; --k) room.anywhere(make_basket(random));
}

void furnish_bedroom(Composer& room) {
    Random& random = room.random();
    if (random.chance(0.5)) room.along_wall(make_built_in_wardrobe(random, random(0.9, 2.6)), true);
    const Blueprint bed = make_double_bed(random);
    if (room.along_wall(bed)) {
        const Composer::Placed at = room.placed().back();
        const Blueprint side = random.chance(0.6) ? make_drawer_unit(random) : make_stool(random);
        const auto box = bed.bounds(), its = side.bounds();
        for (const double s : {-1.0, 1.0}) {
            if (random.chance(0.35)) continue;
            const double off = s > 0 ? box[1][0] - its[0][0] : box[0][0] - its[1][0];
            const Pose pose{off + s * (random.chance(0.5) ? 0.001 : 0.05),
                            box[0][1] - its[0][1] + 0.03};
            room.stand(side, moved(at.pose, pose), {0}, "floor");
        }
    }
    if (random.chance(0.4)) room.along_wall(make_wardrobe(random));
    for (int k = random.integer(0, 2); k > 0; --k) room.along_wall(make_drawer_unit(random));
    if (random.chance(0.5)) room.along_wall(make_bookcase(random, 2.1));
    if (random.chance(0.4) && room.along_wall(make_work_table(random)))
        room.before(room.last(), 0, make_rail_chair(random));
    if (random.chance(0.5)) room.along_wall(make_lamp_on_pole(random));
    if (random.chance(0.4)) room.anywhere(make_rail_chair(random));
    const double clutter = any_clutter(random);
    const std::size_t count = room.placed().size();
    for (std::size_t k = 0; k < count; ++k) {
        const bool soft = room.placed()[k].blueprint.name == "bed" || random.chance(0.2);
        room.fill(k, soft ? 3 : clutter, soft ? make_soft_item : make_home_item);
    }
    scatter_on_floor(room, 4, make_soft_item);
    scatter_on_floor(room, 2, make_store_item);
}

void furnish_living_room(Composer& room) {
    Random& random = room.random();
    if (random.chance(0.5)) {  // a carpet is the floor's, a thick one a thing
        const Vec3& size = room.world().room;
        const double t = random(0.004, 0.014);
        room.add_building_box("carpet", size[0] / 2, size[1] / 2, -0.0001,
                              {random(0.3, 0.6) * size[0], random(0.3, 0.6) * size[1], t});
    }
    for (int k = random.integer(1, 3); k > 0; --k) {
        if (random.chance(0.75))
            room.along_wall(make_couch(random));
        else
            room.anywhere(random.chance(0.5) ? make_bolster_armchair(random) : make_couch(random));
    }
    for (int k = random.integer(0, 2); k > 0; --k)
        room.anywhere(one_of(random, {make_splayed_table, make_drum_table, make_table}));
    if (room.along_wall(make_tv_board(random)) && random.chance(0.8)) {
        const std::size_t board = room.last();
        room.on_surface(board, room.placed()[board].blueprint.surfaces.back(),
                        {make_television(random)});
    }
    for (int k = random.integer(0, 3); k > 0; --k) room.along_wall(make_bookcase(random, 2.3));
    if (random.chance(0.5)) room.along_wall(make_free_cupboard(random));
    if (random.chance(0.4) && room.anywhere(make_work_table(random)))
        seat(room, room.last(), random.integer(1, 6));
    for (int k = random.integer(0, 3); k > 0; --k)
        room.along_wall(make_bush(random, random(0.7, 1.6)));
    for (int k = random.integer(0, 2); k > 0; --k) room.along_wall(make_lamp_on_pole(random));
    if (random.chance(0.3)) room.along_wall(make_arc_lamp(random));
    for (int k = random.integer(0, 2); k > 0; --k)
        room.on_wall(make_wall_shelf(random), random(1.1, 1.6));
    const double clutter = any_clutter(random);
    const std::size_t count = room.placed().size();
    for (std::size_t k = 0; k < count; ++k) {
        const std::string& name = room.placed()[k].blueprint.name;
        room.fill(k,
                  name == "sofa"       ? 2.5
                  : name == "bookcase" ? clutter + 4
                                       : clutter,
                  name == "sofa"       ? make_soft_item
                  : name == "bookcase" ? make_shelf_item
                                       : make_home_item);
    }
    scatter_on_floor(room, 3, make_home_item);
    if (random.chance(0.3)) room.leaning(make_leaning_thing(random));
}

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
