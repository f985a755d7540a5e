// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numbers>
#include <utility>

#include "lab/furniture/things.h"
#include "lab/furniture/varied.h"
#include "lab/rooms/furnish.h"
#include "lab/rooms/goods.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

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

}  // namespace

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

}  // namespace topple::scenes
