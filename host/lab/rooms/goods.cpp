// SPDX-License-Identifier: MIT
#include "lab/rooms/goods.h"

#include <numbers>

namespace topple::scenes {
void load_pallet(Composer& room, std::size_t index) {
    Random& random = room.random();
    const Composer::Placed at = room.placed()[index];
    const Surface surface = at.blueprint.surfaces.front();
    const int nx = random.integer(1, 3), ny = random.integer(1, 2), layers = random.integer(1, 4);
    const double w = 2 * surface.half_x / nx, d = 2 * surface.half_y / ny;
    const std::vector<std::int32_t> planks = room.deck(index, surface);
    const double h = random(0.18, 0.4), top = at.blueprint.height();
    const bool flush = random.chance(0.5);
    const Vec3 size{w - random(0.001, 0.03), d - random(0.001, 0.03), h};
    Blueprint load("load");
    load.pile = true;
    std::vector<std::int32_t> below(static_cast<std::size_t>(nx * ny), -1);
    for (int layer = 0; layer < layers; ++layer) {
        for (int k = 0; k < nx * ny; ++k) {
            const double x = (k % nx + 0.5 - nx / 2.0) * w, y = (k / nx + 0.5 - ny / 2.0) * d;
            if (flush) {
                const int box = load.box("carton", x, y, layer * h, size);
                if (layer == 0) load.feet.push_back(box);
                continue;
            }
            std::int32_t& carrier = below[k];
            if (layer > 0 && (carrier < 0 || random.chance(0.25))) {
                carrier = -1;
                continue;
            }
            const auto on = layer == 0 ? planks : std::vector<std::int32_t>{carrier};
            const Pose pose = moved(at.pose, Pose{x, y, top + layer * h});
            carrier = room.stand(lone_box("carton", "box", size), pose, on, "pallet")
                          ? room.placed().back().first_part
                          : -1;
        }
    }
    if (flush) room.stand(load, {at.pose.x, at.pose.y, top, at.pose.yaw}, planks, "pallet");
}

void aisles(Composer& room, double aisle, Blueprint (*make)(Random&), double clutter,
            Stack (*goods)(Random&, double)) {
    Random& random = room.random();
    const Vec3& size = room.world().room;
    for (double y = aisle + 0.9; y < size[1] - aisle - 0.4; y += aisle + random(0.9, 1.3)) {
        double x = random(aisle, 1.6 * aisle);
        while (x < size[0] - aisle) {
            const Blueprint one = make(random);
            const auto box = one.bounds();
            if (x + box[1][0] - box[0][0] > size[0] - aisle) break;
            if (room.stand(one, {x - box[0][0], y, 0, random.chance(0.9) ? 0 : std::numbers::pi},
                           {0}, "floor"))
                room.fill(room.placed().size() - 1, clutter, goods);
            x += box[1][0] - box[0][0] + (random.chance(0.6) ? 0.001 : random(0.3, 1.2));
        }
    }
}

void leave_on_floor(Composer& room, int count) {
    for (; count > 0; --count) {
        const Stack stack = make_floor_thing(room.random(), 1);
        if (!stack.empty()) room.anywhere(stack.front());
    }
}

}  // namespace topple::scenes
