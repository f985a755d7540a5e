// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/furniture/profiles.h"
#include "lab/furniture/things.h"
#include "lab/furniture/varied.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

Blueprint screen_on_stand(Random& random, double w, const char* name) {
    Blueprint b(name);
    const double h = w * random(0.54, 0.64), low = random(0.04, 0.14);
    b.foot(random.chance(0.5) ? b.box("base", 0, 0, 0, {0.42 * w, random(0.16, 0.24), 0.012})
                              : b.cylinder("base", 0, 0, 0, 0.4 * w, 0.014));
    b.box("neck", 0, -0.03, 0.01, {random(0.03, 0.1), 0.02, low + 0.45 * h});
    b.box("panel", 0, 0, low, {w, 0.035, h});
    b.box("screen", 0, 0.018, low + 0.012, {w - 0.024, 0.004, h - 0.024});
    if (random.chance(0.5)) b.box("panel", 0, -0.02, low + 0.2 * h, {0.6 * w, 0.03, 0.5 * h});
    return b;
}

Blueprint desk_monitor(Random& random) {
    return screen_on_stand(random, random(0.42, 0.72), "monitor");
}

Blueprint mouse(Random&) {
    return lone_box("mouse", "body", {0.065, 0.11, 0.035});
}

Blueprint paper(Random& random) {
    return lone_box("paper", "body", {0.21, 0.297, random(0.01, 0.08)});
}

Blueprint small_bush(Random& random) {
    return make_bush(random, random(0.3, 0.6));
}

Blueprint keyboard(Random& random) {
    Blueprint b("keyboard");
    const double w = random(0.28, 0.46), d = random(0.11, 0.17);
    b.foot(b.box("body", 0, 0, 0, {w, d, 0.014}));
    for (int row = 0; row < 4; ++row)
        b.box("keys", 0, (row - 1.5) * d / 4.6, 0.014, {w - 0.02, d / 6, 0.006});
    return b;
}

Blueprint pen_holder(Random& random) {
    Blueprint b("holder");
    const double r = 0.04, h = random(0.09, 0.12);
    b.foot(b.revolved("cup", 0, 0, 0, vessel_within({{r, 0}, {r, h}}, 0.004, 0.005)));
    for (int k = random.integer(2, 6); k > 0; --k) {
        const double a = random(0, 2 * pi), lean = random(0.05, 0.25);
        b.bar("pen", {0.01 * std::cos(a), 0.01 * std::sin(a), 0.006},
              {0.16 * std::sin(lean) * std::cos(a), 0.16 * std::sin(lean) * std::sin(a), 0.165},
              0.008);
    }
    return b;
}

Stack books(Random& random) {
    Stack stack;
    for (int k = random.integer(1, 5); k > 0; --k)
        stack.push_back(
            lone_box("book", "body", {random(0.14, 0.24), random(0.19, 0.3), random(0.012, 0.05)}));
    return stack;
}

Blueprint telephone(Random& random) {
    Blueprint b("telephone");
    b.foot(b.box("body", 0, 0, 0, {random(0.16, 0.2), 0.2, 0.045}));
    b.box("receiver", -0.05, 0, 0.045, {0.05, 0.19, 0.035});
    return b;
}

Blueprint desk_lamp(Random& random) {
    Blueprint b("desk lamp");
    const double h = random(0.28, 0.5), out = random(0.1, 0.2);
    b.foot(b.cylinder("base", 0, 0, 0, random(0.16, 0.2), 0.025));
    b.bar("arm", {0, -0.03, 0.02}, {0, -0.08, h}, 0.016);
    b.bar("arm", {0, -0.085, h - 0.005}, {0, out - 0.08, h + 0.06}, 0.014);
    b.cone("shade", 0, out - 0.07, h - 0.01, 0.14, 0.1, 0.4);
    return b;
}

Blueprint table_lamp(Random& random) {
    Blueprint b("table lamp");
    const double r = random(0.05, 0.09), h = random(0.14, 0.3);
    b.foot(
        b.revolved("foot", 0, 0, 0, solid_within(smooth_side({r, 1.2 * r, 0.4 * r, 0.2 * r}, h))));
    b.cylinder("column", 0, 0, h - 0.01, 0.014, 0.08);
    b.cone("shade", 0, 0, h + 0.04, 2 * random(0.1, 0.17), random(0.13, 0.22), 0.65);
    return b;
}

Blueprint candle_or_vase(Random& random) {
    Blueprint b("vase");
    const double r = random(0.03, 0.07), h = random(0.12, 0.3);
    b.foot(b.revolved("body", 0, 0, 0,
                      solid_within(smooth_side({0.7 * r, r, 1.1 * r, 0.4 * r, 0.6 * r}, h))));
    for (int k = random.integer(0, 5); k > 0; --k) {
        const double a = random(0, 2 * pi), s = random(0.02, 0.12);
        b.bar("stem", {0, 0, h - 0.02}, {s * std::cos(a), s * std::sin(a), h + 0.2}, 0.006);
        b.sphere("leaf", s * std::cos(a), s * std::sin(a), h + 0.18, random(0.03, 0.07));
    }
    return b;
}

}  // namespace

Blueprint make_television(Random& random) {
    return screen_on_stand(random, random(0.7, 1.3), "television");
}

Blueprint make_bush(Random& random, double scale) {
    Blueprint b("plant");
    const double r = scale * random(0.1, 0.2), h = scale * random(0.15, 0.35);
    b.foot(b.revolved("pot", 0, 0, 0,
                      vessel_within({{0.75 * r, 0}, {r, h}}, 0.08 * r + 0.004, 0.8 * h)));
    b.cylinder("soil", 0, 0, 0.78 * h, 1.7 * r, 0.05 * h);
    const int stems = random.integer(2, 6);
    for (int k = 0; k < stems; ++k) {
        const double a = random(0, 2 * pi), lean = random(0.05, 0.5);
        const double length = scale * random(0.3, 0.8);
        const Vec3 to{length * std::sin(lean) * std::cos(a), length * std::sin(lean) * std::sin(a),
                      0.8 * h + length * std::cos(lean)};
        b.bar("stem", {0, 0, 0.75 * h}, to, 0.008 + 0.008 * scale);
        for (int leaf = random.integer(2, 5); leaf > 0; --leaf) {
            const double f = random(0.4, 1.0);
            const Vec3 middle{f * to[0], f * to[1], 0.75 * h + f * (to[2] - 0.75 * h)};
            const Vec3 size{scale * random(0.05, 0.12), scale * random(0.12, 0.3), 0.004};
            const double yaw = random(-pi, pi), lean = random(-0.9, 0.9);
            b.add({Shape::box, middle, size, yaw, 0, -1, "leaf", lean});
        }
    }
    return b;
}

Blueprint make_basket(Random& random) {
    Blueprint b(random.chance(0.5) ? "basket" : "bin");
    const double w = random(0.2, 0.5), d = random(0.18, 0.4), h = random(0.18, 0.5), t = 0.012;
    if (random.chance(0.4)) {
        const double r = w / 2;
        b.foot(b.revolved("body", 0, 0, 0, vessel_within({{0.85 * r, 0}, {r, h}}, 0.008, 0.01)));
        return b;
    }
    b.foot(b.box("floor", 0, 0, 0, {w, d, t}));
    for (const double s : {-1.0, 1.0}) {
        b.box("side", s * (w - t) / 2, 0, t, {t, d, h});
        b.box("side", 0, s * (d - t) / 2, t, {w - 2 * t, t, h});
    }
    return b;
}

Blueprint make_built_in_wardrobe(Random& random, double length) {
    Blueprint b("wardrobe");
    const double d = random(0.5, 0.65), h = random(1.9, 2.3);
    const int cells = std::max(1, static_cast<int>(length / random(0.5, 1.0)));
    for (int k = 0; k < cells; ++k)
        add_cabinet(
            b, {(k + 0.5 - cells / 2.0) * length / cells, 0, 0.06, {length / cells, d, h - 0.06}},
            random, 0.12);
    b.box("plinth", 0, d / 2 - 0.02, 0, {length, d - 0.04, 0.06});
    return b;
}

Blueprint make_lamp_on_pole(Random& random) {
    Blueprint b("floor lamp");
    const double h = random(1.2, 1.7);
    if (random.chance(0.5)) {
        b.foot(b.cylinder("base", 0, 0, 0, random(0.25, 0.32), 0.03));
        b.cylinder("column", 0, 0, 0.03, 0.025, h);
    } else {
        for (int k = 0; k < 3; ++k) {
            const double a = 2 * pi * k / 3;
            b.foot(b.leg("leg", 0.02 * std::cos(a), 0.02 * std::sin(a), 0, h, 0.025, 0.2, a));
        }
        b.cylinder("column", 0, 0, h - 0.05, 0.06, 0.08);
    }
    b.cone("shade", 0, 0, h, random(0.3, 0.5), random(0.2, 0.32), random(0.5, 0.95));
    return b;
}

Stack make_desk_item(Random& random, double clearance) {
    return any_that_fits(random, clearance,
                         {desk_monitor, desk_monitor, keyboard, mouse, books, books, paper,
                          pen_holder, desk_lamp, telephone, make_kitchen_item, make_turned_item});
}

Stack make_home_item(Random& random, double clearance) {
    return any_that_fits(random, clearance,
                         {table_lamp, candle_or_vase, books, small_bush, make_basket,
                          make_kitchen_item, make_turned_item, make_turned_item});
}

Stack make_soft_item(Random& random, double clearance) {
    Stack stack;
    if (random.chance(0.6)) {
        const double t = random(0.09, 0.16);
        const Vec3 size{random(0.35, 0.7), random(0.3, 0.42), t};
        stack.push_back(lone_rounded("pillow", "pillow", size, 0.46 * t));
    } else {
        for (int k = random.integer(1, 4); k > 0; --k) {
            const double t = random(0.03, 0.07);
            const Vec3 size{random(0.22, 0.36), random(0.2, 0.3), t};
            stack.push_back(lone_rounded("clothes", "cloth", size, 0.4 * t));
        }
    }
    return stack_height(stack) < clearance ? stack : Stack{};
}

Blueprint make_row(Random& random, double length, double height, double depth) {
    const int what = random.integer(0, 2);
    Blueprint b(what == 0 ? "books" : what == 1 ? "folders" : "boxes");
    b.pile = true;
    double x = -length / 2;
    const double even = random(0.04, 0.09);
    while (true) {
        const double t = what == 0 ? random(0.012, 0.05) : even;
        if (x + t > length / 2) break;
        const double h = height * (what == 0 ? random(0.7, 1) : 1);
        const double d = depth * (what == 0 ? random(0.75, 1) : 1);
        b.foot(b.box("volume", x + t / 2, (depth - d) / 2, 0, {t, d, h}));
        x += t + random(0, 0.002);
    }
    if (b.parts.empty()) b.foot(b.box("volume", 0, 0, 0, {length, depth, height}));
    return b;
}

Stack make_shelf_item(Random& random, double clearance) {
    if (random.chance(0.6)) {
        const double h = std::min(clearance - 0.01, random(0.15, 0.33));
        if (h > 0.08) return {make_row(random, random(0.12, 0.9), h, random(0.12, 0.2))};
    }
    if (random.chance(0.4)) {
        Blueprint b = make_carton(random, std::min(0.3, clearance));
        if (b.height() < clearance) return {b};
    }
    return random.chance(0.5) ? make_home_item(random, clearance)
                              : make_desk_item(random, clearance);
}

}  // namespace topple::scenes
