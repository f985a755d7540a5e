// SPDX-License-Identifier: MIT
#include "lab/rooms/measured_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "lab/scan/depth_camera.h"
#include "lab/solids/part_surface.h"
#include "lab/solids/pose.h"

namespace topple::scenes {
namespace {

constexpr double floor_m = 2.4, wall_m = 1.2;  // edge of the floor; height of the walls
constexpr double table_m = 0.7, table_side_m = 0.9, board_m = 0.04, leg_m = 0.06;

void add_bottle(Blueprint& b, double diameter, double height) {
    const double r = diameter / 2, h = height / 2, neck = 0.35 * r;
    b.revolved("", 0, 0, h, {{0, -h}, {r, -h}, {r, 0.2 * h}, {neck, 0.55 * h}, {neck, h}, {0, h}});
}

// Open above, its wall and bottom as thick as told.
void add_vessel(Blueprint& b, double diameter, double height, double wall) {
    const double r = diameter / 2, h = height / 2, inner = r - wall, bottom = wall - h;
    b.revolved("", 0, 0, h, {{0, -h}, {r, -h}, {r, h}, {inner, h}, {inner, bottom}, {0, bottom}});
}

void add_table(Blueprint& b, const Vec3& size, double board, double leg) {
    b.box("", 0, 0, size[2] - board, {size[0], size[1], board});
    for (const auto [sx, sy] : corners)
        b.box("", sx * (size[0] - leg) / 2, sy * (size[1] - leg) / 2, 0,
              {leg, leg, size[2] - board});
}

Blueprint corner_of_room() {
    constexpr double half = floor_m / 2, thick = 0.1;
    Blueprint b("room");
    b.box("", 0, 0, -thick, {floor_m, floor_m, thick});
    b.box("", -half - thick / 2, 0, 0, {thick, floor_m, wall_m});
    b.box("", 0, -half - thick / 2, 0, {floor_m, thick, wall_m});
    return b;
}

void add_hull_points(const Part& part, std::vector<Vec3>& points) {
    const auto axes = part.axes();
    const auto add = [&](double x, double y, double z) {
        points.push_back(combined(part.center, axes, x, y, z));
    };
    const Vec3 half{part.size[0] / 2, part.size[1] / 2, part.size[2] / 2};
    if (part.shape == Shape::box) {
        for (int corner = 0; corner < 8; ++corner) {
            add(corner & 1 ? half[0] : -half[0], corner & 2 ? half[1] : -half[1],
                corner & 4 ? half[2] : -half[2]);
        }
        return;
    }
    constexpr int sides = 1080;
    for (const auto& [r, z] : part.outline()) {
        for (int n = 0; n < (r > 0 ? sides : 1); ++n) {
            const double angle = 2 * std::numbers::pi * n / sides;
            add(r * std::cos(angle), r * std::sin(angle), z);
        }
    }
}

}  // namespace

std::vector<MeasuredShape> measured_shapes() {
    std::vector<MeasuredShape> out;
    const auto thing = [&](const char* name, bool on_table = false) -> Blueprint& {
        return out.emplace_back(MeasuredShape{Blueprint(name), on_table});
    };
    const auto box = [&](const char* name, const Vec3& size, bool on_table = false) {
        thing(name, on_table).box("", 0, 0, 0, size);
    };
    const auto can = [&](const char* name, double diameter, double height, bool on_table = false) {
        thing(name, on_table).cylinder("", 0, 0, 0, diameter, height);
    };
    box("box 20 x 30 x 50", {0.2, 0.3, 0.5});
    box("box 12 x 16 x 30", {0.12, 0.16, 0.3}, true);
    box("box 10 x 7 x 15", {0.1, 0.07, 0.15}, true);
    box("cube 40", {0.4, 0.4, 0.4});
    box("block 6 x 5 x 8", {0.06, 0.05, 0.08}, true);
    box("wardrobe 90 x 50 x 180", {0.9, 0.5, 1.8});
    box("book upright 4 x 18 x 24", {0.04, 0.18, 0.24}, true);
    box("carton 35 x 25 x 12", {0.35, 0.25, 0.12});
    box("column 15 x 15 x 90", {0.15, 0.15, 0.9});
    can("cylinder 12 x 25", 0.12, 0.25);
    can("tin 8 x 11", 0.08, 0.11, true);
    can("bin 30 x 60", 0.3, 0.6);
    can("can 6.5 x 17", 0.065, 0.17, true);
    can("barrel 45 x 90", 0.45, 0.9);
    thing("cone 24 x 40").cone("", 0, 0, 0, 0.24, 0.4, 0);
    thing("pot 20 to 30 x 30").cone("", 0, 0, 0, 0.2, 0.3, 0.3 / 0.2);
    thing("cup 6 to 9 x 11", true).cone("", 0, 0, 0, 0.06, 0.11, 0.09 / 0.06);
    add_vessel(thing("mug 8 x 9 of 5 mm", true), 0.08, 0.09, 0.005);
    add_vessel(thing("bucket 30 x 30 of 5 mm"), 0.3, 0.3, 0.005);
    add_bottle(thing("bottle 7 x 30", true), 0.07, 0.3);
    add_bottle(thing("bottle 9 x 24"), 0.09, 0.24);
    add_bottle(thing("vase 20 x 60"), 0.2, 0.6);
    box("angle 60 x 40 x 80", {0.6, 0.4, 0.3});
    out.back().box("", -0.2, 0, 0.3, {0.2, 0.4, 0.5});
    box("angle 20 x 8 x 20", {0.2, 0.08, 0.06}, true);
    out.back().box("", -0.07, 0, 0.06, {0.06, 0.08, 0.14});
    box("mushroom 40 x 40 x 60", {0.15, 0.15, 0.45});
    out.back().box("", 0, 0, 0.45, {0.4, 0.4, 0.15});
    add_table(thing("table 120 x 80 x 72"), {1.2, 0.8, 0.72}, 0.04, 0.06);
    add_table(thing("side table 45 x 45 x 50"), {0.45, 0.45, 0.5}, 0.05, 0.05);
    add_table(thing("bench 100 x 30 x 45"), {1.0, 0.3, 0.45}, 0.05, 0.06);
    add_table(thing("chair 42 x 45 to 85"), {0.42, 0.42, 0.45}, 0.04, 0.04);
    out.back().box("", 0, -(0.42 - 0.03) / 2, 0.45, {0.42, 0.03, 0.85 - 0.45});
    add_table(thing("stool 34 x 65"), {0.34, 0.34, 0.65}, 0.05, 0.05);
    can("bar table 60 x 105", 0.45, 0.04);
    out.back().cylinder("", 0, 0, 0.04, 0.08, 0.97);
    out.back().cylinder("", 0, 0, 1.01, 0.6, 0.04);
    can("lamp 18 x 45", 0.16, 0.03, true);
    out.back().cylinder("", 0, 0, 0.03, 0.04, 0.25);
    out.back().cone("", 0, 0, 0.28, 0.24, 0.17, 0.14 / 0.24);
    return out;
}

World measured_world(const MeasuredShape& shape, std::uint64_t seed) {
    Random random(seed, 501);
    World world;
    world.seed = seed;
    world.room = {floor_m, floor_m, wall_m};
    world.objects = {{"room", "room"}, {shape.name, shape.on_table ? "table-middle" : "floor"}};
    // About the middle of the room; its walls run along x and y, and the shape askew.
    const double yaw = random(0.1, 1.4), x = random(-0.05, 0.05), y = random(-0.05, 0.05);
    const auto put = [&](const Blueprint& b, const Pose& pose, std::int32_t object) {
        for (const Part& part : b.parts) {
            world.parts.push_back(moved(pose, part));
            world.parts.back().object = object;
        }
    };
    put(corner_of_room(), {}, 0);
    put(shape, {x, y, shape.on_table ? table_m : 0, yaw}, measured_object);
    if (shape.on_table) {
        world.objects.push_back({"table", "floor"});
        Blueprint table("table");
        add_table(table, {table_side_m, table_side_m, table_m}, board_m, leg_m);
        put(table, {}, measured_object + 1);
    }
    // The room's frame begins in its corner.
    for (Part& part : world.parts) {
        part.center[0] += floor_m / 2;
        part.center[1] += floor_m / 2;
    }
    return world;
}

PointCloud clean_points(const World& world, double spacing_m) {
    constexpr double touches_m = 1e-4;
    std::vector<Sheet> sheets;
    for (std::size_t p = 0; p < world.parts.size(); ++p)
        add_sheets(world.parts[p], static_cast<std::int32_t>(p), sheets);
    PointCloud out;
    out.source = "clean points";
    const auto hidden = [&](const Vec3& p, std::int32_t part) {
        // The room is seen from within.
        for (std::size_t a = 0; a < 2; ++a)
            if (p[a] < -touches_m || p[a] > world.room[a] + touches_m) return true;
        if (p[2] < -touches_m) return true;
        return std::ranges::any_of(world.parts, [&](const Part& other) {
            return &other != &world.parts[part] && other.distance(p) < touches_m;
        });
    };
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        std::vector<Patch> patches;
        add_patches(sheets[s], static_cast<std::uint32_t>(s), spacing_m, patches);
        for (const Patch& patch : patches) {
            const Sheet::Place place = patch.spread(sheets[s], 0.5, 0.5);
            if (hidden(place.point, sheets[s].part)) continue;
            out.x.push_back(static_cast<float>(place.point[0]));
            out.y.push_back(static_cast<float>(place.point[1]));
            out.z.push_back(static_cast<float>(place.point[2]));
            out.nx.push_back(static_cast<float>(place.normal[0]));
            out.ny.push_back(static_cast<float>(place.normal[1]));
            out.nz.push_back(static_cast<float>(place.normal[2]));
        }
    }
    return out;
}

std::vector<Mat4> poses_around(const World& world, unsigned frames) {
    constexpr double nearest_m = 0.9, sight = 1.2, beside_wall_m = 0.15;
    Bounds box = no_bounds();
    for (const Vec3& p : hull_points(world, measured_object)) extend(box, p);
    const auto& [low, high] = box;
    const Vec3 middle{(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
    const double across = std::hypot(high[0] - low[0], high[1] - low[1]),
                 away = std::max(nearest_m, across / 2 + sight * (high[2] - low[2]) / 2 + 0.5);
    std::vector<Mat4> out;
    for (unsigned n = 0; n < frames; ++n) {
        const double angle = 2 * std::numbers::pi * n / frames;
        Vec3 eye{middle[0] + away * std::cos(angle), middle[1] + away * std::sin(angle), 0};
        for (std::size_t a = 0; a < 2; ++a) eye[a] = std::max(eye[a], beside_wall_m);
        constexpr std::array<double, 3> heights{0.35, 1.1, 1.7};
        eye[2] = heights[n % heights.size()];
        out.push_back(look_at(eye, middle));
    }
    return out;
}

std::vector<Vec3> hull_points(const World& world, std::int32_t object) {
    std::vector<Vec3> out;
    for (const Part& part : world.parts)
        if (part.object == object) add_hull_points(part, out);
    return out;
}

}  // namespace topple::scenes
