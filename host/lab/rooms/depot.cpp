// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numbers>
#include <utility>

#include "lab/furniture/things.h"
#include "lab/rooms/furnish.h"
#include "lab/rooms/goods.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

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
    Blueprint carton("carton");
    const Vec3 size{random(0.2, 0.7), random(0.2, 0.6), random(0.15, 0.6)};
    carton.foot(carton.box("box", 0, 0, 0, size));
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
