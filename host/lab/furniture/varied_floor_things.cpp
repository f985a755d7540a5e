// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/furniture/profiles.h"
#include "lab/furniture/varied.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

int make_pot(Blueprint& b, double r, double h) {
    // A rim that stands out a little.
    return b.foot(
        b.revolved("pot", 0, 0, 0,
                   solid_within({{0.72 * r, 0}, {0.95 * r, 0.85 * h}, {r, 0.86 * h}, {r, h}})));
}

}  // namespace

// Balls on a stem.
Blueprint make_topiary(Random& random) {
    Blueprint b("topiary");
    const double h = random(0.22, 0.34);
    int below = make_pot(b, random(0.13, 0.2), h);
    double z = h, ball = random(0.28, 0.4);
    for (int k = random.integer(1, 2); k > 0; --k) {
        const double stem = random(0.12, 0.35);
        const int trunk = b.join(below, b.cylinder("trunk", 0, 0, z, 0.035, stem));
        below = b.join(trunk, b.sphere("crown", 0, 0, z + stem, ball));
        z += stem + ball;
        ball *= random(0.6, 0.85);
    }
    return b;
}

// Stiff leaves that lean outwards all around, each standing on the earth in the pot.
Blueprint make_leafy_plant(Random& random, double scale) {
    Blueprint b("plant");
    const double r = scale * random(0.1, 0.15), h = scale * random(0.18, 0.3);
    const int pot = make_pot(b, r, h);
    const int leaves = random.integer(4, 6);
    const double circle = 0.55 * r, width = 1.2 * circle * std::tan(pi / leaves);
    const double first = random(0, 2 * pi);
    for (int k = 0; k < leaves; ++k) {
        // A leaning box goes towards -y of its own.
        const double yaw = first + 2 * pi * k / leaves;
        b.join(pot, b.leaning("leaf", circle * std::sin(yaw), -circle * std::cos(yaw), h,
                              {std::min(width, 0.09 * scale + 0.03), 0.006 + 0.004 * scale,
                               scale * random(0.35, 0.7)},
                              random(0.08, 0.45), yaw));
    }
    return b;
}

// Two bars that meet in a ball, and a shade that looks down from the upper end.
Blueprint make_arc_lamp(Random& random) {
    Blueprint b("arc lamp");
    const double t = 0.07;  // heavy enough for what hangs out over its edge
    const int base = b.foot(b.cylinder("base", 0, 0, 0, random(0.38, 0.44), t));
    b.arm(base, {0, -0.08, t},
          {{random(0.9, 1.15), random(-0.05, 0.08)}, {random(0.28, 0.4), random(0.5, 0.9)}}, 0.03,
          random(0.18, 0.24));
    return b;
}

Blueprint make_coat_stand(Random& random) {
    Blueprint b("coat stand");
    const double h = random(1.5, 1.75), d = 0.045;
    const int foot =
        b.foot(b.revolved("foot", 0, 0, 0, solid_within({{0.19, 0}, {0.19, 0.02}, {0.05, 0.05}})));
    const int pole = b.join(foot, b.cylinder("pole", 0, 0, 0.05, d, h));
    const int pegs = random.integer(3, 4);
    for (int k = 0; k < pegs; ++k) {
        const double yaw = 2 * pi * k / pegs, c = std::cos(yaw), s = std::sin(yaw);
        // Its end stands on the pole's side, across from its axis.
        const double z = 0.05 + h - 0.08 - 0.03 * (k % 2), from = d / 2, to = d / 2 + 0.13;
        b.join(pole, b.bar("peg", {from * c, from * s, z}, {to * c, to * s, z}, 0.025));
    }
    return b;
}

Blueprint make_barrel(Random& random) {
    const double r = random(0.16, 0.24), h = random(0.45, 0.7);
    const double belly = r * random(1.1, 1.25);
    Blueprint b =
        lone_revolved("barrel", "barrel", solid_within(smooth_side({r, belly, belly, r}, h)));
    b.surfaces.push_back({0, 0, 0, 0.65 * r, 0.65 * r, 0.4, "barrel"});
    return b;
}

// A bin or basket that one can look into.
Blueprint make_open_bin(Random& random) {
    const double r = random(0.11, 0.17), h = random(0.25, 0.42);
    const double top = r * random(1.05, 1.4);
    const Side side =
        random.chance(0.5) ? Side{{r, 0}, {top, h}} : smooth_side({r, 1.15 * top, top}, h);
    return lone_revolved("open bin", "bin", vessel_within(side, random(0.008, 0.014), 0.015));
}

// Soft luggage.
Blueprint make_bag(Random& random) {
    const Vec3 size{random(0.35, 0.55), random(0.18, 0.28), random(0.25, 0.5)};
    return lone_rounded("bag", "bag", size, random(0.2, 0.42) * size[1]);
}

Blueprint make_dumbbell(Random& random) {
    Blueprint b("dumbbell");
    const double d = random(0.13, 0.2), disc = random(0.06, 0.1), bar = random(0.12, 0.16),
                 thick = 0.035;
    const int grip = b.lying("grip", 0, 0, d / 2 - thick / 2, bar, thick);
    for (const double side : {-1.0, 1.0}) {
        b.foot(b.join(grip, b.lying("disc", side * (bar + disc) / 2, 0, 0, disc, d)));
    }
    return b;
}

Blueprint make_rug(Random& random) {
    Blueprint b("rug");
    const double t = random(0.012, 0.025);
    b.underfoot = true;
    b.foot(random.chance(0.4) ? b.cylinder("rug", 0, 0, 0, random(0.8, 1.3), t)
                              : b.box("rug", 0, 0, 0, {random(0.8, 1.5), random(0.6, 1.0), t}));
    return b;
}

Blueprint make_leaning_thing(Random& random) {
    const double lean = random(0.1, 0.32);
    switch (random.integer(0, 3)) {
        case 0: {
            Blueprint b("leaning board");
            b.feet = b.leans = {b.leaning(
                "board", 0, 0, 0, {random(0.2, 0.8), random(0.015, 0.04), random(0.9, 1.8)}, lean)};
            return b;
        }
        case 1: {
            Blueprint b("leaning picture");
            b.feet = b.leans = {
                b.leaning("picture", 0, 0, 0,
                          {random(0.5, 0.9), random(0.02, 0.035), random(0.45, 0.75)}, lean)};
            return b;
        }
        case 2: {
            Blueprint b("leaning pole");
            const double d = random(0.035, 0.06), length = random(1.1, 1.8);
            const double low = d / 2 * std::sin(lean);
            b.feet =
                b.leans = {b.bar("pole", {0, 0, low},
                                 {0, -length * std::sin(lean), low + length * std::cos(lean)}, d)};
            return b;
        }
        default: {
            Blueprint b("ladder");
            const double length = random(1.3, 2.1), width = random(0.36, 0.46);
            for (const double side : {-1.0, 1.0}) {
                b.foot(b.leaning("stringer", side * width / 2, 0, 0, {0.03, 0.07, length}, lean));
            }
            b.leans = b.feet;
            b.rungs(b.feet[0], b.feet[1], static_cast<int>(length / 0.28), 0.035);
            return b;
        }
    }
}

}  // namespace topple::scenes
