// SPDX-License-Identifier: MIT
#include "scenes/furnished_room.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "scenes/blueprint.h"
#include "scenes/random.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

constexpr double wall_thickness = 0.12;
constexpr double margin = 0.012;     // between objects that don't touch
constexpr double head_height = 2.0;  // what hangs higher may reach over the free middle
constexpr std::int32_t floor_part = 0;

struct Pose {
    double x = 0, y = 0, z = 0, yaw = 0;
};

Vec3 moved(const Pose& pose, const Vec3& p) {
    const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
    return {pose.x + c * p[0] - s * p[1], pose.y + s * p[0] + c * p[1], pose.z + p[2]};
}

Part moved(const Pose& pose, Part part) {
    part.center = moved(pose, part.center);
    part.yaw += pose.yaw;
    return part;
}

// A blueprint that stands somewhere: where its parts begin, and how it was moved.
struct Placed {
    Blueprint blueprint;
    Pose pose;
    std::int32_t first_part = 0;
};

class Furnisher {
  public:
    explicit Furnisher(const RoomOptions& options)
        : random_(options.seed), clutter_(options.clutter) {
        world_.seed = options.seed;
        build_room();
        place_furniture();
        place_on_walls();
        place_floor_things();
        const std::size_t furniture = placed_.size();
        for (std::size_t k = 0; k < furniture; ++k) fill_surfaces(k);
        tilt(options.tilt_deg);
    }
    World take() { return std::move(world_); }

  private:
    void build_room() {
        const double w = random_.uniform(3.9, 6.2), d = random_.uniform(3.5, 5.2);
        const double h = random_.uniform(2.35, 2.8), t = wall_thickness;
        world_.room = {w, d, h};
        world_.objects.push_back({"room", "room"});
        const auto add = [&](const char* name, double x, double y, double bottom,
                             const Vec3& size) {
            world_.parts.push_back({Shape::box, {x, y, bottom + size[2] / 2}, size, 0, 0, 0, name});
            const auto id = static_cast<std::int32_t>(world_.parts.size()) - 1;
            if (id != floor_part) world_.fixed.emplace_back(floor_part, id);
            return id;
        };
        add("floor", w / 2, d / 2, -t, {w + 2 * t, d + 2 * t, t});
        add("wall", w / 2, -t / 2, 0, {w + 2 * t, t, h});
        add("wall", w / 2, d + t / 2, 0, {w + 2 * t, t, h});
        add("wall", -t / 2, d / 2, 0, {t, d, h});
        add("wall", w + t / 2, d / 2, 0, {t, d, h});
        if (random_.chance(0.3)) {
            const double s = random_.uniform(0.25, 0.45);
            const bool right = random_.chance(0.5), far = random_.chance(0.5);
            const auto pillar =
                add("pillar", right ? w - s / 2 : s / 2, far ? d - s / 2 : s / 2, 0, {s, s, h});
            world_.fixed.emplace_back(far ? 2 : 1, pillar);
            world_.fixed.emplace_back(right ? 4 : 3, pillar);
        }
    }

    // Whether the blueprint's parts keep their distance from all others there, but for contacts of
    // its feet with `supporter` and of its wall parts with `wall`.
    bool fits(const Blueprint& blueprint, const Pose& pose, std::int32_t supporter,
              std::int32_t wall) const {
        const auto middle = free_middle(world_);
        for (std::size_t k = 0; k < blueprint.parts.size(); ++k) {
            const Part part = moved(pose, blueprint.parts[k]);
            const auto box = part.bounds();
            if (box[0][2] < head_height && box[0][0] < world_.room[0] / 2 + middle[0] &&
                box[1][0] > world_.room[0] / 2 - middle[0] &&
                box[0][1] < world_.room[1] / 2 + middle[1] &&
                box[1][1] > world_.room[1] / 2 - middle[1]) {
                return false;
            }
            const auto has = [&](const std::vector<int>& list) {
                return std::find(list.begin(), list.end(), static_cast<int>(k)) != list.end();
            };
            const bool foot = has(blueprint.feet), at_wall = has(blueprint.wall_parts);
            for (std::size_t other = 0; other < world_.parts.size(); ++other) {
                const auto id = static_cast<std::int32_t>(other);
                if ((foot && id == supporter) || (at_wall && id == wall)) continue;
                const auto its = world_.parts[other].bounds();
                bool near = true;
                for (std::size_t a = 0; a < 3; ++a) {
                    near = near && box[0][a] < its[1][a] + margin && its[0][a] < box[1][a] + margin;
                }
                if (near && gap(part, world_.parts[other], 1e-3) < margin) return false;
            }
        }
        return true;
    }

    void place(const Blueprint& blueprint, const Pose& pose, std::int32_t supporter,
               std::int32_t wall, const std::string& where) {
        const auto object = static_cast<std::int32_t>(world_.objects.size());
        const auto first = static_cast<std::int32_t>(world_.parts.size());
        world_.objects.push_back({blueprint.name, where});
        for (const Part& local : blueprint.parts) {
            Part part = moved(pose, local);
            part.object = object;
            world_.parts.push_back(std::move(part));
        }
        for (const auto& [a, b] : blueprint.joints) world_.fixed.emplace_back(first + a, first + b);
        for (const int foot : blueprint.feet) world_.support.emplace_back(supporter, first + foot);
        for (const int part : blueprint.wall_parts) world_.fixed.emplace_back(wall, first + part);
        placed_.push_back({blueprint, pose, first});
    }

    // The pose with the back along wall 1..4 (low y, high y, low x, high x).
    Pose at_wall(std::int32_t wall, double along, double off, double z, double turn) const {
        const double w = world_.room[0], d = world_.room[1];
        switch (wall) {
            case 1:
                return {along * w, off, z, turn};
            case 2:
                return {along * w, d - off, z, pi + turn};
            case 3:
                return {off, along * d, z, -pi / 2 + turn};
            default:
                return {w - off, along * d, z, pi / 2 + turn};
        }
    }

    bool place_along_wall(const Blueprint& blueprint, int attempts = 80) {
        for (int attempt = 0; attempt < attempts; ++attempt) {
            const auto wall = static_cast<std::int32_t>(random_.integer(1, 4));
            const double turn = random_.chance(0.25) ? random_.uniform(-0.12, 0.12) : 0;
            const double off =
                random_.uniform(0.02, 0.06) + (turn == 0 ? 0 : 0.1) - blueprint.back();
            const Pose pose = at_wall(wall, random_.uniform(), off, 0, turn);
            if (!fits(blueprint, pose, floor_part, -1)) continue;
            place(blueprint, pose, floor_part, -1, "floor");
            return true;
        }
        return false;
    }

    bool place_anywhere(const Blueprint& blueprint, int attempts = 60) {
        for (int attempt = 0; attempt < attempts; ++attempt) {
            const Pose pose{random_.uniform(0, world_.room[0]), random_.uniform(0, world_.room[1]),
                            0, random_.uniform(-pi, pi)};
            if (!fits(blueprint, pose, floor_part, -1)) continue;
            place(blueprint, pose, floor_part, -1, "floor");
            return true;
        }
        return false;
    }

    // A chair that faces the table's front, pushed in as far as chance and legs allow.
    void place_chair(std::size_t table) {
        const Placed at = placed_[table];
        const auto box = at.blueprint.bounds();
        const Blueprint chair = make_chair(random_);
        for (int attempt = 0; attempt < 40; ++attempt) {
            const double x = random_.uniform(0.6 * box[0][0], 0.6 * box[1][0]);
            const double y = box[1][1] + random_.uniform(0.02, 0.3);
            const Vec3 p = moved(at.pose, Vec3{x, y, 0});
            const Pose pose{p[0], p[1], 0, at.pose.yaw + pi + random_.uniform(-0.35, 0.35)};
            if (!fits(chair, pose, floor_part, -1)) continue;
            place(chair, pose, floor_part, -1, "floor");
            return;
        }
    }

    void place_furniture() {
        if (random_.chance(0.35)) place_along_wall(make_bed(random_));
        const int tables = random_.integer(1, 2);
        for (int k = 0; k < tables; ++k) {
            const int kind = random_.integer(0, 3);
            const Blueprint table = kind == 0   ? make_pedestal_table(random_)
                                    : kind == 1 ? make_desk(random_)
                                                : make_table(random_);
            if (!place_along_wall(table)) continue;
            const std::size_t index = placed_.size() - 1;
            if (table.height() > 0.6) {
                const int chairs = random_.integer(1, 2);
                for (int c = 0; c < chairs; ++c) place_chair(index);
            }
        }
        const int shelves = random_.integer(1, 2);
        for (int k = 0; k < shelves; ++k) place_along_wall(make_shelf(random_));
        if (random_.chance(0.8)) place_along_wall(make_sofa(random_));
        if (random_.chance(0.6)) place_along_wall(make_dresser(random_));
        if (random_.chance(0.4)) place_along_wall(make_bench(random_));
        if (random_.chance(0.5)) place_along_wall(make_floor_lamp(random_));
        if (random_.chance(0.4)) place_along_wall(make_plant(random_));
        if (random_.chance(0.5)) place_anywhere(make_stool(random_));
        if (random_.chance(0.6)) place_along_wall(make_bin(random_));
    }

    void place_on_walls() {
        const int count = random_.integer(1, 2);
        for (int k = 0; k < count; ++k) {
            const bool cabinet = k == 0 ? random_.chance(0.7) : random_.chance(0.4);
            const Blueprint blueprint =
                cabinet ? make_wall_cabinet(random_) : make_wall_shelf(random_);
            for (int attempt = 0; attempt < 60; ++attempt) {
                const auto wall = static_cast<std::int32_t>(random_.integer(1, 4));
                const double z = cabinet ? random_.uniform(1.4, 1.6) : random_.uniform(1.1, 1.6);
                // The wall part's back lies in the wall's plane; doors stand off in front.
                const Pose pose = at_wall(wall, random_.uniform(), -blueprint.back(), z, 0);
                if (!fits(blueprint, pose, -1, wall)) continue;
                place(blueprint, pose, -1, wall, "wall");
                break;
            }
        }
    }

    void place_floor_things() {
        const int count = static_cast<int>(std::lround(clutter_ * random_.integer(3, 6)));
        for (int k = 0; k < count; ++k) {
            switch (random_.integer(0, 5)) {
                case 0:
                    place_anywhere(make_crate(random_));
                    break;
                case 1:
                    place_anywhere(make_roll(random_));
                    break;
                case 2:
                    place_anywhere(make_marker(random_));
                    break;
                case 3:
                    place_anywhere(make_stool(random_));
                    break;
                default: {
                    const auto item = make_item(random_, 0.5, 0.3);
                    if (item.size() == 1) place_anywhere(item.front());
                }
            }
        }
    }

    void fill_surfaces(std::size_t index) {
        const std::vector<Surface> surfaces = placed_[index].blueprint.surfaces;
        for (const Surface& surface : surfaces) {
            if (surface.half_x <= 0 || surface.half_y <= 0) continue;
            const double area = 4 * surface.half_x * surface.half_y;
            const int most = std::clamp(static_cast<int>(std::lround(area / 0.15)), 1, 5);
            const int count = static_cast<int>(std::lround(clutter_ * random_.integer(0, most)));
            for (int k = 0; k < count; ++k) put_on(index, surface);
        }
    }

    // One item, or a stack, at a random place of the surface where all of its foot is carried.
    void put_on(std::size_t index, const Surface& surface) {
        const Placed base = placed_[index];
        const auto items = make_item(random_, surface.clearance, 0.4);
        if (items.empty()) return;
        for (int attempt = 0; attempt < 15; ++attempt) {
            const double yaw =
                random_.chance(0.4) ? random_.uniform(-0.3, 0.3) : random_.uniform(-pi, pi);
            const auto foot = moved({0, 0, 0, yaw}, items.front().parts[0]).bounds();
            const double room_x = surface.half_x - foot[1][0], room_y = surface.half_y - foot[1][1];
            if (room_x < 0 || room_y < 0) continue;
            const double u = random_.uniform(-room_x, room_x), v = random_.uniform(-room_y, room_y);
            const Part& carrier = base.blueprint.parts[static_cast<std::size_t>(surface.part)];
            const Vec3 p = moved(base.pose, Vec3{surface.x + u, surface.y + v, carrier.top()});
            Pose pose{p[0], p[1], p[2], base.pose.yaw + yaw};
            const std::int32_t supporter = base.first_part + surface.part;
            if (!fits(items.front(), pose, supporter, -1)) continue;
            const double edge =
                std::min(surface.half_x - std::abs(u), surface.half_y - std::abs(v));
            const std::string where = surface.where == "table"
                                          ? (edge < 0.12 ? "table-edge" : "table-middle")
                                          : surface.where;
            place(items.front(), pose, supporter, -1, where);
            pile(items, pose, where);
            return;
        }
    }

    void pile(const std::vector<Blueprint>& items, Pose pose, const std::string& where) {
        for (std::size_t k = 1; k < items.size(); ++k) {
            const std::int32_t below = placed_.back().first_part;
            pose.z += items[k - 1].height();
            // The upper book's corners stay over the lower one for small turns.
            const Pose turned{pose.x, pose.y, pose.z, pose.yaw + random_.uniform(-0.08, 0.08)};
            if (!fits(items[k], turned, below, -1)) return;
            place(items[k], turned, below, -1, where);
        }
    }

    void tilt(double degrees) {
        Vec3 axis{random_.normal(), random_.normal(), random_.normal()};
        const double length = std::hypot(axis[0], axis[1], axis[2]);
        for (double& a : axis) a /= length;
        world_.tilt = rotation(axis, degrees * pi / 180);
    }

    World world_;
    Random random_;
    double clutter_;
    std::vector<Placed> placed_;
};

}  // namespace

std::array<double, 2> free_middle(const World& world) {
    return {0.17 * world.room[0], 0.15 * world.room[1]};
}

World furnished_room(const RoomOptions& options) {
    if (!(options.clutter >= 0 && options.clutter <= 10) || !std::isfinite(options.tilt_deg)) {
        throw Error(ErrorKind::usage, "room: clutter is " + std::to_string(options.clutter) +
                                          " and must be 0 to 10; the tilt must be finite");
    }
    return Furnisher(options).take();
}

}  // namespace topple::scenes
