// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "lab/furniture/profiles.h"
#include "lab/furniture/varied.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

// Legs that spread outwards from points on a circle or at the corners of a rectangle under `top`.
void splayed_legs(Blueprint& b, Random& random, int top, const std::vector<Vec3>& upper_ends,
                  double height, double diameter) {
    const double lean = random(0.1, 0.26);
    for (const Vec3& end : upper_ends) {
        b.foot(b.join(top, b.leg("leg", end[0], end[1], 0, height, diameter, lean,
                                 std::atan2(end[1], end[0]))));
    }
}

std::vector<Vec3> on_circle(int count, double radius) {
    std::vector<Vec3> points;
    for (int k = 0; k < count; ++k) {
        const double angle = 2 * pi * k / count + pi / 2;
        points.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    return points;
}

std::vector<Vec3> on_rectangle(double half_x, double half_y) {
    return {{-half_x, -half_y, 0}, {half_x, -half_y, 0}, {-half_x, half_y, 0}, {half_x, half_y, 0}};
}

}  // namespace

Blueprint make_splayed_stool(Random& random) {
    Blueprint b("stool");
    const double d = random(0.28, 0.36), t = random(0.03, 0.05);
    const double h = random(0.42, 0.68);
    // A disc with a round edge.
    const int seat =
        b.revolved("seat", 0, 0, h - t,
                   solid_within(joined({{d / 2 - t / 2, 0}},
                                       joined(quarter(d / 2 - t / 2, 0, t / 2, t / 2, true),
                                              quarter(d / 2, t / 2, -t / 2, t / 2, false)))));
    splayed_legs(b, random, seat, on_circle(random.integer(3, 4), 0.3 * d), h - t,
                 random(0.028, 0.04));
    b.surfaces.push_back({seat, 0, 0, 0.25 * d, 0.25 * d, 0.3, "seat"});
    return b;
}

Blueprint make_splayed_chair(Random& random) {
    Blueprint b("chair");
    const double w = random(0.42, 0.5), d = random(0.42, 0.48);
    const double h = random(0.43, 0.48), t = random(0.035, 0.06);
    const int seat = b.rounded("seat", 0, 0, h - t, {w, d, t}, 0.45 * t);
    splayed_legs(b, random, seat, on_rectangle(0.36 * w, 0.34 * d), h - t, random(0.03, 0.042));
    // The lower edge of the leaning back stands on the flat of the seat.
    b.join(seat, b.leaning("back", 0, -d / 2 + 0.06, h,
                           {w - 0.04, random(0.02, 0.035), random(0.36, 0.5)}, random(0.1, 0.3)));
    b.surfaces.push_back({seat, 0, 0.05, w / 2 - 0.05, d / 2 - 0.11, 0.4, "seat"});
    return b;
}

// A star of five feet, a column, and a seat with a back on a stem.
Blueprint make_swivel_chair(Random& random) {
    Blueprint b("swivel chair");
    const double hub = 0.07, reach = random(0.2, 0.26), low = 0.05;
    const double h = random(0.44, 0.52), t = random(0.06, 0.09);
    const double w = random(0.44, 0.52), d = random(0.42, 0.48);
    const int column = b.cylinder("column", 0, 0, 0.02, hub, h - t - 0.02);
    const int seat = b.join(column, b.rounded("seat", 0, 0, h - t, {w, d, t}, 0.45 * t));
    for (int k = 0; k < 5; ++k) {
        const double angle = 2 * pi * k / 5 + 0.3, from = hub / 2 + reach / 2;
        b.foot(b.join(column, b.box("foot", from * std::cos(angle), from * std::sin(angle), 0,
                                    {reach, 0.04, low}, angle)));
    }
    const double up = random(0.1, 0.18), back_h = random(0.36, 0.5);
    const int stem = b.join(seat, b.box("stem", 0, -d / 2 + 0.07, h, {0.06, 0.03, up + 0.1}));
    b.join(stem,
           b.rounded("back", 0, -d / 2 + 0.085 + 0.035, h + up, {w - 0.06, 0.07, back_h}, 0.03));
    return b;
}

Blueprint make_rounded_sofa(Random& random) {
    Blueprint b("sofa");
    const bool single = random.chance(0.3);
    const double w = single ? random(0.8, 1.0) : random(1.5, 2.1);
    const double d = random(0.8, 0.95), arm = random(0.14, 0.2);
    const double back = random(0.18, 0.26), leg = random(0.06, 0.14);
    const double base = random(0.16, 0.22), cushion = random(0.14, 0.2);
    const int frame = b.rounded("frame", 0, 0, leg, {w, d, base}, 0.03);
    b.legs("foot", w / 2 - 0.1, d / 2 - 0.1, 0.05, leg, true, frame);
    const double top = leg + base, inner = w - 2 * arm;
    b.join(frame, b.rounded("back", 0, -d / 2 + back / 2 + 0.01, top,
                            {inner, back, cushion + random(0.28, 0.4)}, 0.4 * back));
    for (const double sx : {-1.0, 1.0}) {
        b.join(frame, b.rounded("arm", sx * (w - arm) / 2, 0, top,
                                {arm - 0.006, d - 0.08, cushion + random(0.08, 0.2)}, 0.4 * arm));
    }
    const int seats = single ? 1 : random.integer(2, 3);
    const double each = inner / seats, depth = d - back - 0.06;
    for (int k = 0; k < seats; ++k) {
        const double x = -inner / 2 + (k + 0.5) * each, y = -d / 2 + back + 0.03 + depth / 2;
        const int seat = b.join(
            frame, b.rounded("cushion", x, y, top, {each - 0.01, depth, cushion}, 0.35 * cushion));
        b.surfaces.push_back({seat, x, y, each / 2 - 0.09, depth / 2 - 0.09, 0.4, "sofa"});
    }
    return b;
}

// Arms that are rolls on boards.
Blueprint make_bolster_armchair(Random& random) {
    Blueprint b("armchair");
    const double inner = random(0.5, 0.62), d = random(0.7, 0.82);
    const double h = random(0.36, 0.44), board = 0.06, roll = random(0.13, 0.18);
    const int seat = b.foot(b.box("seat", 0, 0, 0, {inner, d, h}));
    b.join(seat, b.leaning("back", 0, -d / 2 + 0.02, h,
                           {inner - (roll - board) - 0.02, random(0.12, 0.17), random(0.42, 0.55)},
                           random(0.08, 0.2)));
    for (const double sx : {-1.0, 1.0}) {
        const double x = sx * (inner + board) / 2, up = h + random(0.1, 0.14);
        const int side = b.foot(b.join(seat, b.box("side", x, 0.05, 0, {board, d - 0.1, up})));
        b.join(side, b.lying("roll", x, 0.05, up, d - 0.12, roll, pi / 2));
    }
    b.surfaces.push_back({seat, 0, 0.12, inner / 2 - roll / 2, d / 2 - 0.16, 0.4, "sofa"});
    return b;
}

Blueprint make_pouf(Random& random) {
    const double r = random(0.2, 0.3), h = random(0.3, 0.42);
    const double foot = random(0.55, 0.75) * r;
    Blueprint b = lone_revolved(
        "pouf", "pouf",
        solid_within(joined({{foot, 0}}, joined(quarter(foot, 0, r - foot, h / 2, true),
                                                quarter(r, h / 2, foot - r, h / 2, false)))));
    b.surfaces.push_back({0, 0, 0, 0.6 * foot, 0.6 * foot, 0.3, "seat"});
    return b;
}

}  // namespace topple::scenes
