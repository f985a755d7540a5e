// SPDX-License-Identifier: MIT
#include "lab/rooms/measured_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "lab/random.h"
#include "lab/scan/depth_camera.h"
#include "lab/solids/part_surface.h"

namespace topple::scenes {
namespace {

constexpr double floor_m = 2.4, wall_m = 1.2;  // edge of the floor; height of the walls
constexpr double table_m = 0.7, table_side_m = 0.9, board_m = 0.04, leg_m = 0.06;

// Parts of a shape, each by the middle of its underside.
Part part(Shape shape, const Vec3& at, const Vec3& size) {
    Part out;
    out.shape = shape;
    out.center = {at[0], at[1], at[2] + size[2] / 2};
    out.size = size;
    return out;
}
Part box(const Vec3& at, const Vec3& size) {
    return part(Shape::box, at, size);
}
Part cylinder(const Vec3& at, double diameter, double height) {
    return part(Shape::cylinder, at, {diameter, diameter, height});
}
Part cone(const Vec3& at, double base, double top, double height) {
    Part out = part(Shape::cone, at, {base, base, height});
    out.top_ratio = top / base;
    return out;
}
Part bottle(double diameter, double height) {
    const double r = diameter / 2, h = height / 2, neck = 0.35 * r;
    Part out = part(Shape::revolved, {}, {diameter, diameter, height});
    out.profile = {{0, -h}, {r, -h}, {r, 0.2 * h}, {neck, 0.55 * h}, {neck, h}, {0, h}};
    return out;
}
// Open above, its wall and bottom as thick as told.
Part vessel(double diameter, double height, double wall) {
    const double r = diameter / 2, h = height / 2, inner = r - wall, bottom = wall - h;
    Part out = part(Shape::revolved, {}, {diameter, diameter, height});
    out.profile = {{0, -h}, {r, -h}, {r, h}, {inner, h}, {inner, bottom}, {0, bottom}};
    return out;
}
std::vector<Part> table(const Vec3& size, double board, double leg) {
    std::vector<Part> parts{box({0, 0, size[2] - board}, {size[0], size[1], board})};
    for (const double x : {-1, 1}) {
        for (const double y : {-1, 1}) {
            parts.push_back(box({x * (size[0] - leg) / 2, y * (size[1] - leg) / 2, 0},
                                {leg, leg, size[2] - board}));
        }
    }
    return parts;
}
std::vector<Part> chair(double side, double seat, double height) {
    std::vector<Part> parts = table({side, side, seat}, 0.04, 0.04);
    parts.push_back(box({0, -(side - 0.03) / 2, seat}, {side, 0.03, height - seat}));
    return parts;
}

std::array<Part, 3> corner_of_room() {
    constexpr double half = floor_m / 2, thick = 0.1;
    return {box({0, 0, -thick}, {floor_m, floor_m, thick}),
            box({-half - thick / 2, 0, 0}, {thick, floor_m, wall_m}),
            box({0, -half - thick / 2, 0}, {floor_m, thick, wall_m})};
}

void add_hull_points(const Part& part, std::vector<Vec3>& points) {
    const auto axes = part.axes();
    const auto add = [&](double x, double y, double z) {
        Vec3 p = part.center;
        for (std::size_t a = 0; a < 3; ++a)
            p[a] += x * axes[0][a] + y * axes[1][a] + z * axes[2][a];
        points.push_back(p);
    };
    const Vec3 half{part.size[0] / 2, part.size[1] / 2, part.size[2] / 2};
    if (part.shape == Shape::box) {
        for (int corner = 0; corner < 8; ++corner) {
            add(corner & 1 ? half[0] : -half[0], corner & 2 ? half[1] : -half[1],
                corner & 4 ? half[2] : -half[2]);
        }
        return;
    }
    solids::Profile rings = part.profile;
    if (part.shape != Shape::revolved) {
        const double top = part.shape == Shape::cone ? part.top_ratio : 1;
        rings = {{half[0], -half[2]}, {top * half[0], half[2]}};
    }
    constexpr int corners = 1080;
    for (const auto& [r, z] : rings) {
        for (int n = 0; n < (r > 0 ? corners : 1); ++n) {
            const double angle = 2 * std::numbers::pi * n / corners;
            add(r * std::cos(angle), r * std::sin(angle), z);
        }
    }
}

}  // namespace

std::vector<MeasuredShape> measured_shapes() {
    std::vector<MeasuredShape> out;
    const auto add = [&](const std::string& name, std::vector<Part> parts, bool on_table = false) {
        out.push_back({name, std::move(parts), on_table});
    };
    const auto sized = [](const Vec3& size) { return std::vector{box({}, size)}; };
    add("box 20 x 30 x 50", sized({0.2, 0.3, 0.5}));
    add("box 12 x 16 x 30", sized({0.12, 0.16, 0.3}), true);
    add("box 10 x 7 x 15", sized({0.1, 0.07, 0.15}), true);
    add("cube 40", sized({0.4, 0.4, 0.4}));
    add("block 6 x 5 x 8", sized({0.06, 0.05, 0.08}), true);
    add("wardrobe 90 x 50 x 180", sized({0.9, 0.5, 1.8}));
    add("book upright 4 x 18 x 24", sized({0.04, 0.18, 0.24}), true);
    add("carton 35 x 25 x 12", sized({0.35, 0.25, 0.12}));
    add("column 15 x 15 x 90", sized({0.15, 0.15, 0.9}));
    add("cylinder 12 x 25", {cylinder({}, 0.12, 0.25)});
    add("tin 8 x 11", {cylinder({}, 0.08, 0.11)}, true);
    add("bin 30 x 60", {cylinder({}, 0.3, 0.6)});
    add("can 6.5 x 17", {cylinder({}, 0.065, 0.17)}, true);
    add("barrel 45 x 90", {cylinder({}, 0.45, 0.9)});
    add("cone 24 x 40", {cone({}, 0.24, 0, 0.4)});
    add("pot 20 to 30 x 30", {cone({}, 0.2, 0.3, 0.3)});
    add("cup 6 to 9 x 11", {cone({}, 0.06, 0.09, 0.11)}, true);
    add("mug 8 x 9 of 5 mm", {vessel(0.08, 0.09, 0.005)}, true);
    add("bucket 30 x 30 of 5 mm", {vessel(0.3, 0.3, 0.005)});
    add("bottle 7 x 30", {bottle(0.07, 0.3)}, true);
    add("bottle 9 x 24", {bottle(0.09, 0.24)});
    add("vase 20 x 60", {bottle(0.2, 0.6)});
    add("angle 60 x 40 x 80",
        {box({0, 0, 0}, {0.6, 0.4, 0.3}), box({-0.2, 0, 0.3}, {0.2, 0.4, 0.5})});
    add("angle 20 x 8 x 20",
        {box({0, 0, 0}, {0.2, 0.08, 0.06}), box({-0.07, 0, 0.06}, {0.06, 0.08, 0.14})}, true);
    add("mushroom 40 x 40 x 60",
        {box({0, 0, 0}, {0.15, 0.15, 0.45}), box({0, 0, 0.45}, {0.4, 0.4, 0.15})});
    add("table 120 x 80 x 72", table({1.2, 0.8, 0.72}, 0.04, 0.06));
    add("side table 45 x 45 x 50", table({0.45, 0.45, 0.5}, 0.05, 0.05));
    add("bench 100 x 30 x 45", table({1.0, 0.3, 0.45}, 0.05, 0.06));
    add("chair 42 x 45 to 85", chair(0.42, 0.45, 0.85));
    add("stool 34 x 65", table({0.34, 0.34, 0.65}, 0.05, 0.05));
    add("bar table 60 x 105", {cylinder({}, 0.45, 0.04), cylinder({0, 0, 0.04}, 0.08, 0.97),
                               cylinder({0, 0, 1.01}, 0.6, 0.04)});
    add("lamp 18 x 45",
        {cylinder({}, 0.16, 0.03), cylinder({0, 0, 0.03}, 0.04, 0.25),
         cone({0, 0, 0.28}, 0.24, 0.14, 0.17)},
        true);
    return out;
}

World measured_world(const MeasuredShape& shape, std::uint64_t seed) {
    Random random(seed, 501);
    World world;
    world.seed = seed;
    world.room = {floor_m, floor_m, wall_m};
    world.objects = {{"room", "room"}, {shape.name, shape.on_table ? "table-middle" : "floor"}};
    // About the middle of the room; its walls run along x and y, and the shape askew.
    const double yaw = random(0.1, 1.4), cosine = std::cos(yaw), sine = std::sin(yaw);
    const Vec3 at{random(-0.05, 0.05), random(-0.05, 0.05), shape.on_table ? table_m : 0};
    const auto put = [&](Part part, std::int32_t object) {
        part.object = object;
        world.parts.push_back(std::move(part));
    };
    for (const Part& part : corner_of_room()) put(part, 0);
    for (Part part : shape.parts) {
        const Vec3 c = part.center;
        part.center = {at[0] + cosine * c[0] - sine * c[1], at[1] + sine * c[0] + cosine * c[1],
                       at[2] + c[2]};
        part.yaw += yaw;
        put(part, measured_object);
    }
    if (shape.on_table) {
        world.objects.push_back({"table", "floor"});
        for (const Part& part : table({table_side_m, table_side_m, table_m}, board_m, leg_m))
            put(part, measured_object + 1);
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
        for (std::size_t other = 0; other < world.parts.size(); ++other) {
            if (static_cast<std::int32_t>(other) != part &&
                world.parts[other].distance(p) < touches_m)
                return true;
        }
        return false;
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
