// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "lab/furniture/varied.h"
#include "lab/rooms/furnisher.h"

namespace topple::scenes {
namespace {

class VariedRoom {
  public:
    // A stream of its own: a seed's varied room is not its plain room with other things.
    explicit VariedRoom(const RoomOptions& options)
        : room_(options, 1), random_(room_.random()), clutter_(options.clutter) {
        build_shell();
        place_large_things();
        place_seating();
        place_against_walls();
        place_upright_things();
        const std::size_t furniture = room_.placed().size();
        for (std::size_t k = 0; k < furniture; ++k) fill_surfaces(k);
        place_floor_things();
        if (random_.chance(0.5)) room_.place_anywhere(make_rug(random_), 300);
        room_.tilt(options.tilt_deg);
    }
    World take() { return std::move(room_.world()); }

  private:
    void build_shell() {
        room_.build_room();
        const Vec3& size = room_.world().room;
        if (random_.chance(0.25)) {  // the room is an L
            const Vec3 block{random_(0.7, 0.3 * size[0]), random_(0.7, 0.3 * size[1]), size[2]};
            const bool right = random_.chance(0.5), far = random_.chance(0.5);
            if (room_.world().parts.size() == 5) room_.add_corner("corner", block, right, far);
        }
        if (!random_.chance(0.4)) return;
        constexpr double thick = 0.1;
        const std::int32_t ceiling = room_.add_room_part("ceiling", size[0] / 2, size[1] / 2,
                                                         size[2], {size[0], size[1], thick}, {});
        for (std::int32_t part = 1; part < ceiling; ++part)
            room_.world().fixed.emplace_back(part, ceiling);
        hang_lamp(ceiling);
    }

    void hang_lamp(std::int32_t ceiling) {
        const Vec3& size = room_.world().room;
        const Blueprint lamp = make_hanging_lamp(random_);
        const Pose pose{random_(0.25, 0.75) * size[0], random_(0.25, 0.75) * size[1], size[2], 0};
        if (room_.fits(lamp, pose, -1, ceiling)) room_.place(lamp, pose, -1, ceiling, "ceiling");
    }

    void place_large_things() {
        constexpr std::array<BlueprintMake, 5> makes{make_podium, make_stairs, make_loft_bed,
                                                     make_made_bed, make_made_bed};
        const std::size_t which = random_.index(makes.size() + 1);
        if (which < makes.size()) room_.place_along_wall(makes[which](random_));
        if (random_.chance(0.5)) room_.place_along_wall(make_wardrobe(random_));
        const int shelves = random_.integer(0, 2);
        for (int k = 0; k < shelves; ++k) {
            room_.place_along_wall(random_.chance(0.7) ? make_cube_shelf(random_)
                                                       : make_shelf(random_));
        }
        if (random_.chance(0.7)) {
            room_.place_along_wall(random_.chance(0.6) ? make_rounded_sofa(random_)
                                                       : make_bolster_armchair(random_));
        }
    }

    void place_seating() {
        const int tables = random_.integer(1, 2);
        for (int k = 0; k < tables; ++k) {
            const Blueprint table =
                random_.chance(0.7) ? make_splayed_table(random_) : make_pedestal_table(random_);
            if (!room_.place_along_wall(table)) continue;
            const std::size_t index = room_.placed().size() - 1;
            if (table.height() < 0.6) continue;
            for (int chairs = random_.integer(1, 2); chairs > 0; --chairs)
                room_.place_before(
                    index, one_of(random_, {make_chair, make_swivel_chair, make_splayed_chair,
                                            make_splayed_chair}));
        }
        if (random_.chance(0.6)) room_.place_along_wall(make_drum_table(random_));
        for (int stools = random_.integer(0, 2); stools > 0; --stools)
            room_.place_anywhere(make_splayed_stool(random_));
        if (random_.chance(0.5)) room_.place_anywhere(make_pouf(random_));
    }

    void place_against_walls() {
        for (int count = random_.integer(2, 4); count > 0; --count) {
            const WallThing thing = make_wall_thing(random_);
            room_.place_at_wall(thing.blueprint, thing.lowest, thing.highest);
        }
        for (int count = random_.integer(1, 3); count > 0; --count)
            room_.place_leaning(make_leaning_thing(random_));
    }

    void place_upright_things() {
        if (random_.chance(0.5)) room_.place_along_wall(make_topiary(random_));
        if (random_.chance(0.5)) room_.place_along_wall(make_leafy_plant(random_, 1));
        if (random_.chance(0.4)) room_.place_along_wall(make_arc_lamp(random_));
        if (random_.chance(0.4)) room_.place_along_wall(make_coat_stand(random_));
        if (random_.chance(0.4)) room_.place_anywhere(make_barrel(random_));
        if (random_.chance(0.6)) room_.place_anywhere(make_open_bin(random_));
    }

    void place_floor_things() {
        const int count = static_cast<int>(std::lround(clutter_ * random_.integer(2, 5)));
        for (int k = 0; k < count; ++k) {
            switch (random_.integer(0, 4)) {
                case 0:
                    put_on_floor(make_pile(random_, {0.42, 0.34, 0.28}, random_.integer(2, 4)));
                    break;
                case 1:
                    room_.place_anywhere(make_bag(random_));
                    break;
                case 2:
                    room_.place_anywhere(make_dumbbell(random_));
                    break;
                default:
                    put_on_floor(make_varied_item(random_, 0.6, 0.35));
            }
        }
    }

    void fill_surfaces(std::size_t index) {
        room_.each_place_on(index, clutter_, [&](const Surface& surface) {
            put_on(index, surface, any_group(surface));
        });
    }

    Group any_group(const Surface& surface) {
        const bool soft = surface.where == "bed" || surface.where == "sofa";
        if (soft && random_.chance(0.7)) return make_pillow(random_);
        if (surface.where == "podium" && random_.chance(0.6)) {
            constexpr std::array<BlueprintMake, 3> makes{make_splayed_stool, make_pouf,
                                                         make_topiary};
            const std::size_t which = random_.index(makes.size() + 1);
            if (which < makes.size()) return {{makes[which](random_), {}}};
            return make_pile(random_, {0.4, 0.32, 0.25}, random_.integer(2, 3));
        }
        return make_varied_item(random_, surface.clearance, 0.4);
    }

    // Whether all of a group that stands on `supporter` has room.
    bool group_fits(const Group& group, const Pose& pose, std::int32_t supporter) const {
        return std::all_of(group.begin(), group.end(), [&](const Member& m) {
            return room_.fits(m.blueprint, moved(pose, m.pose), m.on < 0 ? supporter : -1, -1);
        });
    }

    void place_group(const Group& group, const Pose& pose, std::int32_t supporter,
                     const std::string& where) {
        const std::size_t first = room_.placed().size();
        for (const Member& m : group) {
            const std::int32_t below =
                m.on < 0 ? supporter
                         : room_.placed()[first + static_cast<std::size_t>(m.on)].first_part;
            room_.place(m.blueprint, moved(pose, m.pose), below, -1, where);
        }
    }

    void put_on(std::size_t index, const Surface& surface, const Group& group) {
        if (group.empty() || height(group) > surface.clearance) return;
        const Furnisher::Placed base = room_.placed()[index];
        const std::int32_t supporter = base.first_part + surface.part;
        const auto spot = room_.spot_on(
            base, surface, [&](double yaw) { return reach(group, yaw); },
            [&](const Pose& pose) { return group_fits(group, pose, supporter); });
        if (spot) place_group(group, spot->pose, supporter, Furnisher::where(surface, spot->edge));
    }

    void put_on_floor(const Group& group) {
        constexpr std::int32_t floor = 0;
        const Vec3& size = room_.world().room;
        for (int attempt = 0; attempt < 60 && !group.empty(); ++attempt) {
            const double x = random_(0, size[0]), y = random_(0, size[1]);
            const Pose pose{x, y, 0, random_(-std::numbers::pi, std::numbers::pi)};
            if (!group_fits(group, pose, floor)) continue;
            place_group(group, pose, floor, "floor");
            return;
        }
    }

    Furnisher room_;
    Random& random_;
    double clutter_;
};

}  // namespace

World varied_room(const RoomOptions& options) {
    return VariedRoom(options).take();
}

}  // namespace topple::scenes
