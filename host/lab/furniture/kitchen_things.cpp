// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/furniture/profiles.h"
#include "lab/furniture/things.h"

namespace topple::scenes {
namespace {

// A bar or a knob on a front whose outer face is at y.
void add_handle(Blueprint& b, double x, double y, double z, bool upright, int style,
                Random& random) {
    const double length = random(0.1, 0.2);
    if (style == 0) {
        b.sphere("knob", x, y + 0.014, z - 0.014, 0.028);
        return;
    }
    if (style == 1) {
        const Vec3 size = upright ? Vec3{0.012, 0.012, length} : Vec3{length, 0.012, 0.012};
        b.box("handle", x, y + 0.03, z - size[2] / 2, size);
        for (const double s : {-0.4, 0.4})
            b.box("handle", x + (upright ? 0 : s * length), y + 0.0125,
                  z + (upright ? s * length : 0) - 0.005, {0.01, 0.025, 0.01});
    }
}

struct Front {
    double x, y, bottom, wide, high;  // its back at y
    int style;
    bool hinge_left;
};

void add_front(Blueprint& b, const Front& f, const char* name, bool drawer, Random& random) {
    const int front = b.box(name, f.x, f.y + 0.01, f.bottom, {f.wide, 0.02, f.high});
    const double side = f.hinge_left ? 1 : -1;
    b.parts[front].opening = drawer ? Opening::slide : hinge_at(-side);
    add_handle(b, drawer ? f.x : f.x + side * (f.wide / 2 - 0.05), f.y + 0.02,
               drawer ? f.bottom + 0.6 * f.high : f.bottom + 0.5 * f.high, !drawer, f.style,
               random);
}

void add_open_box(Blueprint& b, const CabinetPlace& p, Random& random) {
    const auto [w, d, h] = p.size;
    constexpr double t = 0.018;
    b.box("back", p.x, p.back + 0.004, p.bottom, {w, 0.008, h});
    for (const double s : {-1.0, 1.0})
        b.box("side", p.x + s * (w - t) / 2, p.back + d / 2, p.bottom, {t, d, h});
    const int boards = 2 + static_cast<int>(h / random(0.3, 0.5));
    for (int k = 0; k < boards; ++k) {
        const double z = p.bottom + k * (h - t) / (boards - 1);
        const int board = b.box("board", p.x, p.back + d / 2, z, {w - 2 * t, d, t});
        if (k + 1 < boards)
            b.surfaces.push_back({board, p.x, p.back + d / 2, w / 2 - 0.03, d / 2 - 0.02,
                                  (h - t) / (boards - 1) - t - 0.005, "shelf"});
    }
}

}  // namespace

int add_cabinet(Blueprint& b, const CabinetPlace& p, Random& random, double open) {
    const auto [w, d, h] = p.size;
    const double y = p.back + d;
    if (random.chance(open)) {
        add_open_box(b, p, random);
        const int top = b.box("top", p.x, p.back + d / 2, p.bottom + h - 0.018, {w, d, 0.018});
        if (random.chance(0.6)) {  // a door ajar
            const double side = random.chance(0.5) ? 1 : -1, angle = random(0.5, 1.8);
            const int door = b.box("door", p.x + side * (w / 2 - std::cos(angle) * w / 2),
                                   y + 0.012 + std::sin(angle) * w / 2, p.bottom + 0.003,
                                   {w, 0.02, h - 0.006}, -side * angle);
            b.parts[door].opening = hinge_at(side);
        }
        return top;
    }
    const int body = b.box("body", p.x, p.back + d / 2, p.bottom, {w, d, h});
    const double gap = random(0.002, 0.005);
    const int style = random.integer(0, 2);
    if (random.chance(0.4)) {
        const int drawers = std::max(1, static_cast<int>(h / random(0.15, 0.35)));
        for (int k = 0; k < drawers; ++k) {
            const double out = random.chance(0.08) ? random(0.03, 0.2) : 0;
            if (out > 0)
                b.box("drawer", p.x, y + out / 2, p.bottom + k * h / drawers + 0.03,
                      {w - 0.05, out, 0.7 * h / drawers - 0.02});
            add_front(b,
                      {p.x, y + out, p.bottom + k * h / drawers + gap / 2, w - gap,
                       h / drawers - gap, style, true},
                      "drawer", true, random);
        }
        return body;
    }
    const int doors = w > 0.55 ? 2 : 1;
    for (int k = 0; k < doors; ++k)
        add_front(b,
                  {p.x + (k - (doors - 1) / 2.0) * w / doors, y, p.bottom + gap / 2,
                   w / doors - gap, h - gap, style, k == 0},
                  "door", false, random);
    return body;
}

namespace {

// Cabinets side by side, all along x.
void add_cabinets(Blueprint& b, const Vec3& size, double back, double bottom, Random& random,
                  double open) {
    const auto [length, d, h] = size;
    for (double x = -length / 2; x < length / 2 - 0.05;) {
        double w = random(0.3, 0.8);
        if (x + w > length / 2 - 0.3) w = length / 2 - x;
        add_cabinet(b, {x + w / 2, back, bottom, {w, d, h}}, random, open);
        x += w;
    }
}

}  // namespace

Blueprint make_counter(Random& random, double length) {
    Blueprint b("counter");
    const double d = random(0.52, 0.65), h = random(0.84, 0.95);
    const double plinth = random(0.08, 0.15), t = random(0.025, 0.045);
    const double back = -d / 2, open = random.chance(0.3) ? 0.4 : 0.05;
    b.box("plinth", 0, back + d / 2 - 0.04, 0, {length, d - 0.08, plinth});
    add_cabinets(b, {length, d - 0.025, h - t - plinth}, back, plinth, random, open);
    const double top = h - t, deep = d + random(0, 0.03), over = back + deep / 2;
    const double sink = std::min(0.5, 0.3 * length), middle = random(-0.3, 0.3) * length;
    if (length > 1.3 && random.chance(0.7)) {  // the worktop goes around a sink
        const double low = middle - sink / 2, high = middle + sink / 2, rim = 0.08;
        const int left =
            b.box("worktop", (low - length / 2) / 2, over, top, {low + length / 2, deep, t});
        const int right =
            b.box("worktop", (high + length / 2) / 2, over, top, {length / 2 - high, deep, t});
        b.box("worktop", middle, back + rim / 2, top, {sink, rim, t});
        b.box("worktop", middle, back + deep - rim / 2, top, {sink, rim, t});
        b.box("sink", middle, over, top - 0.12, {sink, deep, 0.12});
        b.cylinder("tap", middle, back + 0.04, h, 0.03, 0.25);
        b.box("tap", middle, back + 0.11, h + 0.23, {0.02, 0.16, 0.02});
        for (const int part : {left, right}) b.stand_on(part, 0.45, "counter", 0.03);
    } else {
        const int one = b.box("worktop", 0, over, top, {length, deep, t});
        if (length > 1.0 && random.chance(0.5)) {
            const double at = random(-0.25, 0.25) * length;
            b.box("hob", at, over, h, {0.56, 0.48, 0.008});
            for (const double sx : {-0.14, 0.14}) {
                for (const double sy : {-0.11, 0.11})
                    b.cylinder("ring", at + sx, over + sy, h, random(0.14, 0.2), 0.02);
            }
            const double half = (length / 2 + at - 0.3) / 2;
            b.surfaces.push_back(
                {one, -length / 2 + half, over, half - 0.02, deep / 2 - 0.03, 0.45, "counter"});
        } else {
            b.stand_on(one, 0.45, "counter", 0.03);
        }
    }
    if (random.chance(0.4))
        b.box("splashback", 0, back + 0.006, h, {length, 0.012, random(0.06, 0.5)});
    return b;
}

Blueprint make_wall_cupboards(Random& random, double length) {
    Blueprint b("wall cabinet");
    const double h = random(0.4, 0.9), d = random(0.28, 0.38);
    add_cabinets(b, {length, d, h}, 0, 0, random, 0.15);
    return b;
}

Blueprint make_hood(Random& random) {
    Blueprint b("hood");
    const double w = random(0.5, 0.9), d = 0.45;
    b.box("body", 0, d / 2, 0, {w, d, 0.06});
    b.box("body", 0, 0.17, 0.06, {0.5 * w, 0.3, 0.12});
    b.box("duct", 0, 0.14, 0.18, {0.26, 0.26, random(0.3, 0.5)});
    return b;
}

Blueprint make_fridge(Random& random) {
    Blueprint b("fridge");
    const double w = random(0.54, 0.75), d = random(0.52, 0.65);
    const double h = random(0.85, 1.95), foot = 0.03;
    const int body = b.box("body", 0, 0, foot, {w, d, h - foot});
    b.legs("foot", w / 2 - 0.05, d / 2 - 0.05, 0.04, foot, true);
    const double split = h > 1.3 ? random(0.3, 0.7) * h : h;
    const double side = random.chance(0.5) ? 1 : -1;
    double from = foot + 0.02;
    for (const double to : {split, h}) {
        if (to - from < 0.1) continue;
        const int door =
            b.rounded("door", 0, d / 2 + 0.03, from, {w, 0.055, to - from - 0.006}, 0.01);
        b.parts[door].opening = hinge_at(-side);
        b.box("handle", side * (w / 2 - 0.05), d / 2 + 0.085, from + 0.4 * (to - from),
              {0.02, 0.02, std::min(0.4, 0.4 * (to - from))});
        for (const double s : {0.42, 0.75})
            b.box("handle", side * (w / 2 - 0.05), d / 2 + 0.067, from + s * (to - from),
                  {0.02, 0.025, 0.02});
        from = to;
    }
    b.stand_on(body, 0.35, "fridge", 0.04);
    return b;
}

Blueprint make_appliance(Random& random) {
    const int which = random.integer(0, 2);
    Blueprint b(which == 0 ? "dishwasher" : which == 1 ? "washing machine" : "oven");
    const double w = random(0.45, 0.62), d = random(0.5, 0.6), h = random(0.8, 0.92), foot = 0.02;
    const int body = b.box("body", 0, 0, foot, {w, d, h - foot});
    for (const double s : {-1.0, 1.0})
        b.foot(b.box("foot", s * (w / 2 - 0.04), 0, 0, {0.05, d - 0.06, foot}));
    if (which == 1) {
        b.lying("door", 0, d / 2 + 0.02, 0.25 * h, 0.05, 0.34, std::numbers::pi / 2);
    } else {
        const int door = b.box("door", 0, d / 2 + 0.012, foot + 0.08, {w - 0.01, 0.024, h - 0.26});
        b.parts[door].opening = Opening::hinge_below;
        b.box("handle", 0, d / 2 + 0.05, h - 0.22, {0.7 * w, 0.02, 0.02});
        for (const double s : {-0.3, 0.3})
            b.box("handle", s * w, d / 2 + 0.032, h - 0.22, {0.02, 0.02, 0.02});
    }
    for (int k = random.integer(0, 4); k > 0; --k)
        b.lying("knob", -0.4 * w + 0.12 * k, d / 2 + 0.012, h - 0.1, 0.024, 0.035,
                std::numbers::pi / 2);
    b.stand_on(body, 0.4, "appliance", 0.03);
    return b;
}

Blueprint make_free_cupboard(Random& random) {
    Blueprint b("cupboard");
    const double w = random(0.5, 1.2), d = random(0.32, 0.5), h = random(0.75, 1.9),
                 leg = random(0.03, 0.15);
    b.legs("foot", w / 2 - 0.03, d / 2 - 0.03, 0.05, leg);
    const int top = add_cabinet(b, {0, -d / 2, leg, {w, d, h - leg}}, random, 0.45);
    b.stand_on(top, 0.5, "cupboard", 0.03);
    return b;
}

namespace {

void add_ring_handle(Blueprint& b, double radius, double z, double size) {
    b.box("handle", radius + size / 2, 0, z - size / 2, {size, 0.012, 0.012});
    b.box("handle", radius + size / 2, 0, z + size / 2, {size, 0.012, 0.012});
    b.box("handle", radius + size, 0, z - size / 2, {0.012, 0.014, size + 0.012});
}

Blueprint kettle(Random& random) {
    Blueprint b("kettle");
    const double r = random(0.07, 0.1), h = random(0.15, 0.24);
    b.foot(b.revolved("body", 0, 0, 0, solid_within(smooth_side({r, r, 0.8 * r, 0.6 * r}, h))));
    b.sphere("knob", 0, 0, h - 0.005, 0.03);
    b.box("handle", 0.75 * r + 0.05, 0, 0.9 * h, {0.14, 0.02, 0.02});
    b.box("handle", r + 0.055, 0, 0.35 * h, {0.02, 0.02, 0.55 * h});
    b.bar("spout", {-0.8 * r, 0, 0.5 * h}, {-1.5 * r, 0, 0.9 * h}, 0.03);
    return b;
}

Blueprint pan(Random& random) {
    Blueprint b("pan");
    const double r = random(0.09, 0.15), h = random(0.05, 0.16);
    b.foot(b.revolved("body", 0, 0, 0, vessel_within({{0.9 * r, 0}, {r, h}}, 0.006, 0.006)));
    if (random.chance(0.5)) {
        b.box("handle", r + 0.09, 0, h - 0.03, {0.2, 0.025, 0.015});
    } else {
        for (const double s : {-1.0, 1.0})
            b.box("handle", s * (r + 0.02), 0, h - 0.03, {0.05, 0.08, 0.012});
    }
    return b;
}

Blueprint handled_mug(Random& random) {
    Blueprint b("mug");
    const double r = random(0.035, 0.048), h = random(0.08, 0.12);
    b.foot(b.revolved("body", 0, 0, 0, vessel_within({{r, 0}, {r * 1.05, h}}, 0.005, 0.006)));
    add_ring_handle(b, r, 0.5 * h, 0.032);
    return b;
}

Blueprint jar(Random& random) {
    Blueprint b("jar");
    const double r = random(0.035, 0.07), h = random(0.08, 0.24);
    b.foot(b.cylinder("glass", 0, 0, 0, 2 * r, h));
    b.cylinder("lid", 0, 0, h, 1.9 * r, random(0.015, 0.03));
    return b;
}

Blueprint food_box(Random& random) {
    return lone_box("food box", "box", {random(0.08, 0.22), random(0.04, 0.12), random(0.1, 0.32)});
}

Stack plates(Random& random) {
    Stack stack;
    const double r = random(0.08, 0.14);
    for (int k = random.integer(1, 3); k > 0; --k) {
        stack.push_back(
            lone_revolved("plate", "plate", solid_within({{0.6 * r, 0}, {r, 0.02}, {r, 0.024}})));
    }
    return stack;
}

Blueprint board_flat(Random& random) {
    return lone_box("chopping board", "board",
                    {random(0.25, 0.45), random(0.16, 0.3), random(0.01, 0.03)});
}

Blueprint toaster(Random& random) {
    Blueprint b(random.chance(0.5) ? "microwave" : "toaster");
    const bool big = b.name == "microwave";
    const Vec3 size =
        big ? Vec3{random(0.42, 0.52), 0.34, 0.27} : Vec3{random(0.24, 0.36), 0.17, 0.2};
    for (const double s : {-1.0, 1.0})
        b.foot(b.box("foot", s * 0.4 * size[0], 0, 0, {0.03, 0.8 * size[1], 0.012}));
    b.rounded("body", 0, 0, 0.012, size, 0.015);
    b.box("door", -0.05, size[1] / 2 + 0.005, 0.03, {0.7 * size[0], 0.012, 0.8 * size[2]});
    b.box("handle", 0.28 * size[0], size[1] / 2 + 0.025, 0.06, {0.02, 0.03, 0.6 * size[2]});
    return b;
}

}  // namespace

Stack make_kitchen_item(Random& random, double clearance) {
    return any_that_fits(random, clearance,
                         {kettle, pan, handled_mug, handled_mug, jar, food_box, plates, board_flat,
                          toaster, make_turned_item, make_turned_item});
}

}  // namespace topple::scenes
