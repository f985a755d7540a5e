// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "lab/rooms/composer.h"

// The building's part of a Composer's room.
namespace topple::scenes {

std::int32_t Composer::add_building_box(const char* name, double x, double y, double bottom,
                                        const Vec3& size) {
    return add_building({Shape::box, {x, y, bottom + size[2] / 2}, size, 0, 0, 0, name});
}

// A box in a wall: `inset` is how far its front lies behind the wall's face, negative in front.
void Composer::wall_piece(int wall, const char* name, double from, double to, double bottom,
                          double top, double inset, double deep) {
    if (to - from < 1e-3 || top - bottom < 1e-3) return;
    const Pose pose = against_wall(wall, (from + to) / 2, -inset - deep / 2, bottom, 0);
    const bool x_along = wall < 2;
    const Vec3 size{x_along ? to - from : deep, x_along ? deep : to - from, top - bottom};
    add_building_box(name, pose.x, pose.y, bottom, size);
}

void Composer::build(const Shell& shell) {
    world_.room = shell.size;
    world_.objects.push_back({"building", "room", false});
    const auto [w, d, h] = shell.size;
    thickness_ = random_(0.08, 0.3);
    add_building_box("floor", w / 2, d / 2, -0.1, {w + 2 * thickness_, d + 2 * thickness_, 0.1});
    if (random_.chance(0.4)) skirting_ = random_(0.008, 0.02);
    std::array<double, 4> height{};
    int stands = 0;
    // Many who scan see half of the walls, and not up to the ceiling.
    const double missing = random_.chance(0.4) ? random_(0.3, 0.8) : shell.missing;
    const double low = random_.chance(0.15) ? 0.6 : shell.low;
    for (double& each : height) {
        if (random_.chance(missing)) continue;
        each = random_.chance(low) ? random_(0.9, h) : h;
        ++stands;
    }
    if (stands == 0) height[random_.integer(0, 3)] = h;
    int windows = random_.integer(0, shell.windows), doors = random_.integer(0, shell.doors);
    for (int wall = 0; wall < 4; ++wall) {
        const double high = height[wall];
        if (high == 0) continue;
        walls_.push_back(wall);
        std::vector<Opening> openings;
        double at = random_(0.2, 0.8);
        const double length = wall_length(wall);
        for (int k = 0; k < 3 && high == h; ++k) {
            const bool door = random_.chance(0.5);
            int& left = door ? doors : windows;
            const double wide = door ? random_(0.75, 1.0) : random_(0.6, 1.8);
            if (left == 0 || at + wide + 0.15 > length || h < 2.2) continue;
            --left;
            const double top = door ? random_(1.95, 2.1) : random_(1.9, h - 0.1);
            openings.push_back({at, at + wide, door ? 0 : random_(0.75, 1.2), top, door});
            at += wide + random_(0.15, 1.2);
        }
        build_wall(wall, high, openings);
    }
    if (random_.chance(shell.ceiling))
        add_building_box("ceiling", w / 2, d / 2, h, {w + 2 * thickness_, d + 2 * thickness_, 0.1});
    if (shell.fittings) add_fittings();
}

void Composer::build_wall(int wall, double height, const std::vector<Opening>& openings) {
    const double length = wall_length(wall);
    wall_part_[wall] = static_cast<std::int32_t>(world_.parts.size());
    double from = -thickness_;
    for (const Opening& o : openings) {
        wall_piece(wall, "wall", from, o.from, 0, height, 0, thickness_);
        wall_piece(wall, "wall", o.from, o.to, 0, o.bottom, 0, thickness_);
        wall_piece(wall, "wall", o.from, o.to, o.top, height, 0, thickness_);
        fill_opening(wall, o);
        from = o.to;
    }
    wall_piece(wall, "wall", from, length + thickness_, 0, height, 0, thickness_);
    if (skirting_ == 0) return;
    from = 0;
    for (const Opening& o : openings) {
        if (!o.door) continue;
        wall_piece(wall, "skirting", from, o.from, 0, 0.08, -skirting_, skirting_);
        from = o.to;
    }
    wall_piece(wall, "skirting", from, length, 0, 0.08, -skirting_, skirting_);
}

void Composer::fill_opening(int wall, const Opening& o) {
    const double inset = 0.6 * thickness_;
    if (o.door) {
        const double wide = o.to - o.from;
        const Pose a = against_wall(wall, o.from, 0, 0, 0), b = against_wall(wall, o.to, 0.7, 0, 0);
        free_.push_back({Vec3{std::min(a.x, b.x), std::min(a.y, b.y), 0.03},
                         Vec3{std::max(a.x, b.x), std::max(a.y, b.y), 1.9}});
        if (random_.chance(0.3)) return;  // open
        if (random_.chance(0.5)) {        // closed
            wall_piece(wall, "door", o.from + 0.003, o.to - 0.003, 0.005, o.top - 0.004, inset,
                       0.04);
            wall_piece(wall, "handle", o.from + 0.06, o.from + 0.18, 1.02, 1.04, inset - 0.05,
                       0.05);
            return;
        }
        // Ajar into the room, its hinge at the opening's far edge.
        const double angle = random_(0.15, 1.5);
        const Pose hinge = against_wall(wall, o.to, 0.005, 0, 0);
        const Pose way = against_wall(wall, o.from, 0.005, 0, 0);
        const double dx = (way.x - hinge.x) / wide, dy = (way.y - hinge.y) / wide;
        const Pose inwards = against_wall(wall, o.to, 1.005, 0, 0);
        const double nx = inwards.x - hinge.x, ny = inwards.y - hinge.y;
        const double ux = std::cos(angle) * dx + std::sin(angle) * nx,
                     uy = std::cos(angle) * dy + std::sin(angle) * ny;
        add_building(
            {Shape::box,
             {hinge.x + ux * wide / 2 + nx * 0.02, hinge.y + uy * wide / 2 + ny * 0.02, o.top / 2},
             {wide - 0.01, 0.04, o.top - 0.02},
             std::atan2(uy, ux),
             0,
             0,
             "door"});
        return;
    }
    const double frame = random_(0.03, 0.07);
    wall_piece(wall, "window", o.from, o.from + frame, o.bottom, o.top, inset, 0.05);
    wall_piece(wall, "window", o.to - frame, o.to, o.bottom, o.top, inset, 0.05);
    wall_piece(wall, "window", o.from, o.to, o.bottom, o.bottom + frame, inset, 0.05);
    wall_piece(wall, "window", o.from, o.to, o.top - frame, o.top, inset, 0.05);
    if (random_.chance(0.5))
        wall_piece(wall, "window", (o.from + o.to) / 2 - frame, (o.from + o.to) / 2 + frame,
                   o.bottom, o.top, inset, 0.05);
    if (random_.chance(0.7))
        wall_piece(wall, "pane", o.from, o.to, o.bottom, o.top, inset + 0.02, 0.01);
    if (random_.chance(0.6)) {
        const double out = random_(0.02, 0.16);
        wall_piece(wall, "sill", o.from - 0.04, o.to + 0.04, o.bottom - 0.03, o.bottom, -out, out);
    }
    if (random_.chance(0.4)) hang_curtain(wall, o);
}

// Cloth in folds: upright strips that turn to and fro, under a rod.
void Composer::hang_curtain(int wall, const Opening& o) {
    const double bottom = random_.chance(0.6) ? random_(0.01, 0.05) : o.bottom - 0.1;
    const double top = std::min(o.top + 0.12, world_.room[2] - 0.03);
    const double strip = random_(0.05, 0.11), turn = random_(0.3, 0.9);
    for (const double side : {0.0, 1.0}) {
        if (random_.chance(0.2)) continue;
        const double covered = random_(0.15, 0.5) * (o.to - o.from);
        const double from = side == 0 ? o.from - 0.15 : o.to + 0.15 - covered;
        Blueprint b("curtain");
        const double step = strip * std::cos(turn);
        const int strips = std::max(2, static_cast<int>(covered / step));
        for (int k = 0; k < strips; ++k)
            b.box("strip", (k + 0.5 - strips / 2.0) * step, 0, bottom, {strip, 0.006, top - bottom},
                  k % 2 == 0 ? turn : -turn);
        b.lying("rod", 0, 0, top, covered + 0.1, 0.02);
        const double deep = 0.5 * strip * std::sin(turn) + 0.025;
        const Pose pose = against_wall(wall, from + covered / 2, deep + skirting_, 0, 0);
        fix(b, pose);
    }
}

void Composer::add_fittings() {
    const auto [w, d, h] = world_.room;
    if (random_.chance(0.2)) {  // a pillar or a chimney breast
        const double a = random_(0.2, 0.6), b = random_(0.15, 0.5);
        const double off = random_.chance(0.7) ? b / 2 : random_(b / 2, d / 2);
        add_building_box("wall", random_(a, w - a), off, 0, {a, b, h});
    }
    if (random_.chance(0.2) && w > 3.5 && d > 2.5) {  // a wall into the room, seen from both sides
        const double x = random_(0.35, 0.65) * w, reach = random_(0.2, 0.5) * d;
        const double high = random_.chance(0.7) ? h : random_(1.0, 1.8);
        add_building_box("wall", x, reach / 2, 0, {random_(0.06, 0.15), reach, high});
    }
    for (int k = random_.integer(0, 2); k > 0; --k) {
        Blueprint b("radiator");
        const int ribs = random_.integer(6, 18);
        const double high = random_(0.4, 0.75);
        const bool panel = random_.chance(0.5);
        if (panel) b.box("panel", 0, 0.06, 0, {0.06 * ribs, 0.02, high});
        for (int r = 0; r < ribs; ++r)
            b.box("rib", (r - ribs / 2.0 + 0.5) * 0.06, panel ? 0.035 : 0.05, 0.02,
                  {panel ? 0.02 : 0.045, panel ? 0.03 : 0.1, high - 0.04});
        b.lying("pipe", 0, 0.05, 0.03, 0.06 * ribs, 0.03);
        b.box("bracket", 0, 0.01, 0.3, {0.05, 0.03, 0.05});
        on_wall(b, random_(0.08, 0.2));
    }
    for (int k = random_.integer(0, 3); k > 0; --k) {
        Blueprint b(random_.chance(0.6) ? "picture" : "board");
        const double wide = random_(0.2, 1.3), high = wide * random_(0.6, 1.3);
        const double deep = random_(0.01, 0.04);
        b.box("sheet", 0, 0, 0, {wide, deep, high});
        if (random_.chance(0.5)) {
            for (const double s : {-1.0, 1.0}) {
                b.box("rim", s * wide / 2, 0.005, 0, {0.03, deep + 0.01, high});
                b.box("rim", 0, 0.005, s < 0 ? 0 : high - 0.03, {wide, deep + 0.01, 0.03});
            }
        }
        on_wall(b, random_(0.9, 1.5));
    }
    if (random_.chance(0.3)) {
        const int wall = any_wall();
        const Pose p = against_wall(wall, random_(0.1, wall_length(wall) - 0.1), 0.035, 0, 0);
        const double r = random_(0.02, 0.06);
        Blueprint pipe("pipe");
        pipe.cylinder("pipe", 0, 0, 0, r, h);
        if (fits(pipe, {p.x, p.y, 0, 0})) add_building(moved({p.x, p.y, 0, 0}, pipe.parts.front()));
    }
}

}  // namespace topple::scenes
