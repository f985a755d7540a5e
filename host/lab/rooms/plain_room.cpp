// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <utility>

#include "lab/rooms/furnisher.h"

namespace topple::scenes {
namespace {

class PlainRoom {
  public:
    explicit PlainRoom(const RoomOptions& options)
        : room_(options), random_(room_.random()), clutter_(options.clutter) {
        room_.build_room();
        place_furniture();
        place_on_walls();
        place_floor_things();
        const std::size_t furniture = room_.placed().size();
        for (std::size_t k = 0; k < furniture; ++k) fill_surfaces(k);
        room_.tilt(options.tilt_deg);
    }
    World take() { return std::move(room_.world()); }

  private:
    void place_furniture() {
        if (random_.chance(0.35)) room_.place_along_wall(make_bed(random_));
        const int tables = random_.integer(1, 2);
        for (int k = 0; k < tables; ++k) {
            const int kind = random_.integer(0, 3);
            const Blueprint table = kind == 0   ? make_pedestal_table(random_)
                                    : kind == 1 ? make_desk(random_)
                                                : make_table(random_);
            if (!room_.place_along_wall(table)) continue;
            const std::size_t index = room_.placed().size() - 1;
            if (table.height() > 0.6) {
                const int chairs = random_.integer(1, 2);
                for (int c = 0; c < chairs; ++c) room_.place_before(index, make_chair(random_));
            }
        }
        const int shelves = random_.integer(1, 2);
        for (int k = 0; k < shelves; ++k) room_.place_along_wall(make_shelf(random_));
        if (random_.chance(0.8)) room_.place_along_wall(make_sofa(random_));
        if (random_.chance(0.6)) room_.place_along_wall(make_dresser(random_));
        if (random_.chance(0.4)) room_.place_along_wall(make_bench(random_));
        if (random_.chance(0.5)) room_.place_along_wall(make_floor_lamp(random_));
        if (random_.chance(0.4)) room_.place_along_wall(make_plant(random_));
        if (random_.chance(0.5)) room_.place_anywhere(make_stool(random_));
        if (random_.chance(0.6)) room_.place_along_wall(make_bin(random_));
    }

    void place_on_walls() {
        const int count = random_.integer(1, 2);
        for (int k = 0; k < count; ++k) {
            const bool cabinet = k == 0 ? random_.chance(0.7) : random_.chance(0.4);
            const Blueprint blueprint =
                cabinet ? make_wall_cabinet(random_) : make_wall_shelf(random_);
            room_.place_at_wall(blueprint, cabinet ? 1.4 : 1.1, 1.6);
        }
    }

    void place_floor_things() {
        const int count = static_cast<int>(std::lround(clutter_ * random_.integer(3, 6)));
        for (int k = 0; k < count; ++k) {
            constexpr std::array<BlueprintMake, 4> makes{make_crate, make_roll, make_marker,
                                                         make_stool};
            const std::size_t which = random_.index(makes.size() + 2);
            if (which < makes.size()) {
                room_.place_anywhere(makes[which](random_));
            } else {
                const auto item = make_item(random_, 0.5, 0.3);
                if (item.size() == 1) room_.place_anywhere(item.front());
            }
        }
    }

    void fill_surfaces(std::size_t index) {
        room_.each_place_on(index, clutter_,
                            [&](const Surface& surface) { put_on(index, surface); });
    }

    // One item, or a stack, at a random place of the surface where all of its foot is carried.
    void put_on(std::size_t index, const Surface& surface) {
        const Furnisher::Placed base = room_.placed()[index];
        const auto items = make_item(random_, surface.clearance, 0.4);
        if (items.empty()) return;
        const std::int32_t supporter = base.first_part + surface.part;
        const auto reach = [&](double yaw) {
            const auto foot = moved({0, 0, 0, yaw}, items.front().parts[0]).bounds();
            return std::array<double, 2>{foot[1][0], foot[1][1]};
        };
        const auto spot = room_.spot_on(base, surface, reach, [&](const Pose& pose) {
            return room_.fits(items.front(), pose, supporter, -1);
        });
        if (!spot) return;
        const std::string where = Furnisher::where(surface, spot->edge);
        room_.place(items.front(), spot->pose, supporter, -1, where);
        pile(items, spot->pose, where);
    }

    void pile(const std::vector<Blueprint>& items, Pose pose, const std::string& where) {
        for (std::size_t k = 1; k < items.size(); ++k) {
            const std::int32_t below = room_.placed().back().first_part;
            pose.z += items[k - 1].height();
            // The upper book's corners stay over the lower one for small turns.
            const Pose turned{pose.x, pose.y, pose.z, pose.yaw + random_(-0.08, 0.08)};
            if (!room_.fits(items[k], turned, below, -1)) return;
            room_.place(items[k], turned, below, -1, where);
        }
    }

    Furnisher room_;
    Random& random_;
    double clutter_;
};

}  // namespace

World plain_room(const RoomOptions& options) {
    return PlainRoom(options).take();
}

}  // namespace topple::scenes
