// SPDX-License-Identifier: MIT
#include "lab/rooms/furnisher.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace topple::scenes {
namespace {

using std::numbers::pi;

constexpr double wall_thickness = 0.12;
constexpr double margin = 0.012;     // between objects that don't touch
constexpr double head_height = 2.0;  // what hangs higher may reach over the free middle
constexpr std::int32_t floor_part = 0;

bool has(const std::vector<int>& list, std::size_t k) {
    return std::find(list.begin(), list.end(), static_cast<int>(k)) != list.end();
}

}  // namespace

Furnisher::Furnisher(const RoomOptions& options, std::uint64_t stream)
    : RoomMaker(options.seed, stream), size_(options.size), keep_free_(options.keep_free) {
    world_.seed = options.seed;
}

std::int32_t Furnisher::add_room_part(const char* name, double x, double y, double bottom,
                                      const Vec3& size, const std::vector<std::int32_t>& to) {
    const std::int32_t id =
        add_own({Shape::box, {x, y, bottom + size[2] / 2}, size, 0, 0, 0, name});
    for (const std::int32_t other : to) world_.fixed.emplace_back(other, id);
    return id;
}

void Furnisher::build_room() {
    const double width = random_(3.9, 6.2), depth = random_(3.5, 5.2);
    const double height = random_(2.35, 2.8), t = wall_thickness;
    world_.room = size_.value_or(Vec3{width, depth, height});
    const auto [w, d, h] = world_.room;
    world_.objects.push_back({"room", "room"});
    add_room_part("floor", w / 2, d / 2, -t, {w + 2 * t, d + 2 * t, t}, {});
    add_room_part("wall", w / 2, -t / 2, 0, {w + 2 * t, t, h}, {floor_part});
    add_room_part("wall", w / 2, d + t / 2, 0, {w + 2 * t, t, h}, {floor_part});
    add_room_part("wall", -t / 2, d / 2, 0, {t, d, h}, {floor_part});
    add_room_part("wall", w + t / 2, d / 2, 0, {t, d, h}, {floor_part});
    if (random_.chance(0.3)) {
        const double s = random_(0.25, 0.45);
        add_corner("pillar", {s, s, h}, random_.chance(0.5), random_.chance(0.5));
    }
}

void Furnisher::add_corner(const char* name, const Vec3& size, bool right, bool far) {
    const double x = right ? world_.room[0] - size[0] / 2 : size[0] / 2;
    const double y = far ? world_.room[1] - size[1] / 2 : size[1] / 2;
    const Bounds box{Vec3{x - size[0] / 2, y - size[1] / 2, 0},
                     Vec3{x + size[0] / 2, y + size[1] / 2, size[2]}};
    if (is_kept_free(box)) return;
    add_room_part(name, x, y, 0, size, {floor_part, far ? 2 : 1, right ? 4 : 3});
}

bool Furnisher::is_kept_free(const Bounds& box) const {
    return std::any_of(keep_free_.begin(), keep_free_.end(),
                       [&](const auto& free) { return overlap(free, box); });
}

bool Furnisher::fits(const Blueprint& blueprint, const Pose& pose, std::int32_t supporter,
                     std::int32_t wall) const {
    const auto half = free_middle(world_);
    const double x = world_.room[0] / 2, y = world_.room[1] / 2;
    const Bounds middle{Vec3{x - half[0], y - half[1], -1},
                        Vec3{x + half[0], y + half[1], head_height}};
    for (std::size_t k = 0; k < blueprint.parts.size(); ++k) {
        const Part part = moved(pose, blueprint.parts[k]);
        const auto box = part.bounds();
        if (!blueprint.underfoot && (overlap(box, middle) || is_kept_free(box))) return false;
        const bool foot = has(blueprint.feet, k);
        const bool at_wall = has(blueprint.wall_parts, k) || has(blueprint.leans, k);
        for (std::size_t other = 0; other < world_.parts.size(); ++other) {
            const auto id = static_cast<std::int32_t>(other);
            if ((foot && id == supporter) || (at_wall && id == wall)) continue;
            if (overlap(box, boxes_[other], margin) &&
                gap(part, world_.parts[other], 1e-3) < margin)
                return false;
        }
    }
    return true;
}

void Furnisher::place(const Blueprint& blueprint, const Pose& pose, std::int32_t supporter,
                      std::int32_t wall, const std::string& where) {
    const std::int32_t first = add(blueprint, pose, where);
    for (const int foot : blueprint.feet) world_.support.emplace_back(supporter, first + foot);
    for (const int part : blueprint.wall_parts) world_.fixed.emplace_back(wall, first + part);
}

Pose Furnisher::at_wall(std::int32_t wall, double along, double off, double z, double turn) const {
    return against_wall(wall - 1, along * world_.room[wall <= 2 ? 0 : 1], off, z, turn);
}

bool Furnisher::place_on_floor(const Blueprint& blueprint, int attempts,
                               const std::function<Pose()>& any) {
    for (int attempt = 0; attempt < attempts; ++attempt) {
        const Pose pose = any();
        if (!fits(blueprint, pose, floor_part, -1)) continue;
        place(blueprint, pose, floor_part, -1, "floor");
        return true;
    }
    return false;
}

bool Furnisher::place_along_wall(const Blueprint& blueprint, int attempts) {
    return place_on_floor(blueprint, attempts, [&] {
        const int wall = random_.integer(1, 4);
        const double turn = random_.chance(0.25) ? random_(-0.12, 0.12) : 0;
        const double off = random_(0.02, 0.06) + (turn == 0 ? 0 : 0.1) - blueprint.back();
        return at_wall(wall, random_.uniform(), off, 0, turn);
    });
}

bool Furnisher::place_anywhere(const Blueprint& blueprint, int attempts) {
    return place_on_floor(blueprint, attempts, [&] {
        return Pose{random_(0, world_.room[0]), random_(0, world_.room[1]), 0, random_(-pi, pi)};
    });
}

bool Furnisher::place_in_plane_of_wall(const Blueprint& blueprint, std::int32_t supporter,
                                       const std::function<double()>& height) {
    for (int attempt = 0; attempt < 60; ++attempt) {
        const auto wall = static_cast<std::int32_t>(random_.integer(1, 4));
        const double z = height();
        const Pose pose = at_wall(wall, random_.uniform(), -blueprint.back(), z, 0);
        if (!fits(blueprint, pose, supporter, wall)) continue;
        place(blueprint, pose, supporter, wall, "wall");
        return true;
    }
    return false;
}

bool Furnisher::place_at_wall(const Blueprint& blueprint, double lowest, double highest) {
    return place_in_plane_of_wall(blueprint, -1, [&] { return random_(lowest, highest); });
}

bool Furnisher::place_leaning(const Blueprint& blueprint) {
    return place_in_plane_of_wall(blueprint, floor_part, [] { return 0.0; });
}

bool Furnisher::place_before(std::size_t table, const Blueprint& chair) {
    const Placed at = placed_[table];
    const auto box = at.blueprint.bounds();
    return place_on_floor(chair, 40, [&] {
        const double x = random_(0.6 * box[0][0], 0.6 * box[1][0]);
        const double y = box[1][1] + random_(0.02, 0.3);
        Pose pose = moved(at.pose, Pose{x, y, 0, pi});
        pose.yaw += random_(-0.35, 0.35);
        return pose;
    });
}

std::optional<Furnisher::Spot> Furnisher::spot_on(const Placed& base, const Surface& surface,
                                                  const Reach& reach,
                                                  const std::function<bool(const Pose&)>& free) {
    for (int attempt = 0; attempt < 15; ++attempt) {
        const double yaw = random_.chance(0.4) ? random_(-0.3, 0.3) : random_(-pi, pi);
        const auto far = reach(yaw);
        const double room_x = surface.half_x - far[0], room_y = surface.half_y - far[1];
        if (room_x < 0 || room_y < 0) continue;
        const double u = random_(-room_x, room_x), v = random_(-room_y, room_y);
        const Part& carrier = base.blueprint.parts[surface.part];
        const Pose pose = moved(base.pose, Pose{surface.x + u, surface.y + v, carrier.top(), yaw});
        if (!free(pose)) continue;
        return Spot{pose, std::min(surface.half_x - std::abs(u), surface.half_y - std::abs(v))};
    }
    return {};
}

void Furnisher::each_place_on(std::size_t placed, double clutter,
                              const std::function<void(const Surface&)>& put) {
    const std::vector<Surface> surfaces = placed_[placed].blueprint.surfaces;  // put() places more
    for (const Surface& surface : surfaces) {
        if (surface.half_x <= 0 || surface.half_y <= 0) continue;
        const double area = 4 * surface.half_x * surface.half_y;
        const int most = std::clamp(static_cast<int>(std::lround(area / 0.15)), 1, 5);
        const int count = static_cast<int>(std::lround(clutter * random_.integer(0, most)));
        for (int k = 0; k < count; ++k) put(surface);
    }
}

std::string Furnisher::where(const Surface& surface, double edge) {
    if (surface.where != "table") return surface.where;
    return edge < 0.12 ? "table-edge" : "table-middle";
}

void Furnisher::tilt(double degrees) {
    Vec3 axis{random_.normal(), random_.normal(), random_.normal()};
    const double length = std::hypot(axis[0], axis[1], axis[2]);
    for (double& a : axis) a /= length;
    world_.tilt = rotation(axis, degrees * pi / 180);
}

}  // namespace topple::scenes
