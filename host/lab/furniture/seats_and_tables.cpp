// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/furniture/things.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

// Legs at the corners of a slab whose lower face is at `high`.
void add_legs(Blueprint& b, double w, double d, double high, double thick, bool round) {
    b.legs("leg", (w - thick) / 2, (d - thick) / 2, thick, high, round);
}

}  // namespace

Blueprint make_rail_chair(Random& random) {
    Blueprint b("chair");
    const double w = random(0.38, 0.5), d = random(0.38, 0.48);
    const double h = random(0.42, 0.48), t = random(0.02, 0.06);
    const double leg = random(0.022, 0.045), top = random(0.78, 1.05);
    const bool round = random.chance(0.5);
    add_legs(b, w, d, h - t, leg, round);
    if (random.chance(0.5)) {
        b.rounded("seat", 0, 0, h - t, {w, d, t}, 0.4 * t);
    } else {
        b.box("seat", 0, 0, h - t, {w + 0.01, d + 0.01, t});
    }
    if (random.chance(0.6)) {  // rails between the legs
        const double z = random(0.1, 0.3);
        for (const double s : {-1.0, 1.0}) {
            b.box("rail", s * (w - leg) / 2, 0, z, {0.7 * leg, d - leg, 0.025});
            b.box("rail", 0, s * (d - leg) / 2, z + 0.04, {w - leg, 0.7 * leg, 0.025});
        }
    }
    const double back = -(d - leg) / 2, lean = random(0, 0.2);
    const auto shift = [&](double z) { return back - std::tan(lean) * (z - h); };
    for (const double s : {-1.0, 1.0})
        b.bar("post", {s * (w - leg) / 2, back, h - 0.02}, {s * (w - leg) / 2, shift(top), top},
              leg);
    switch (random.integer(0, 2)) {
        case 0:  // slats across
            for (double z = h + random(0.1, 0.2); z < top - 0.05; z += 0.13)
                b.box("slat", 0, shift(z), z, {w - leg, 0.015, random(0.04, 0.08)});
            break;
        case 1:  // upright ones under a rail
            b.box("slat", 0, shift(top - 0.05), top - 0.06, {w, 0.025, 0.06});
            for (int k = 0; k < 4; ++k) {
                const double x = (k - 1.5) * w / 5;
                b.bar("slat", {x, back, h - 0.01}, {x, shift(top - 0.05), top - 0.05}, 0.014);
            }
            break;
        default: {  // a curved panel of strips
            const double low = h + random(0.05, 0.22);
            for (int k = 0; k < 5; ++k) {
                const double x = (k - 2.0) * w / 5;
                const double bow = 0.03 * (1 - std::abs(k - 2.0) / 2);
                b.box("panel", x, shift((low + top) / 2) - bow, low,
                      {w / 5 + 0.004, 0.018, top - low}, -0.13 * (k - 2.0) / 2);
            }
        }
    }
    if (random.chance(0.3)) {  // arms
        const double z = h + random(0.17, 0.24);
        for (const double s : {-1.0, 1.0}) {
            b.box("arm", s * (w - leg) / 2, back / 2, z, {0.04, d - 0.06, 0.025});
            b.box("post", s * (w - leg) / 2, d / 2 - 0.09, h - 0.01, {0.025, 0.025, z - h + 0.02});
        }
    }
    return b;
}

Blueprint make_office_chair(Random& random) {
    Blueprint b("swivel chair");
    const double reach = random(0.27, 0.33), h = random(0.42, 0.55);
    const double first = random(0, pi);
    for (int k = 0; k < 5; ++k) {
        const double a = first + 2 * pi * k / 5, c = std::cos(a), s = std::sin(a);
        b.bar("star", {0, 0, 0.1}, {reach * c, reach * s, 0.065}, 0.03);
        b.foot(b.sphere("caster", reach * c, reach * s, 0, 0.055));
    }
    b.cylinder("column", 0, 0, 0.08, 0.05, h - 0.14);
    b.box("plate", 0, 0, h - 0.08, {0.2, 0.2, 0.03});
    const double w = random(0.44, 0.52), d = random(0.42, 0.5);
    b.rounded("seat", 0, 0.02, h - 0.055, {w, d, 0.075}, 0.03);
    const double lean = random(0.02, 0.25), high = random(0.35, 0.75);
    b.box("spine", 0, -d / 2, h - 0.06, {0.06, 0.03, 0.25});
    b.cushion("back", {0, -d / 2 - 0.02 - std::sin(lean) * high / 2, h + 0.12 + high / 2},
              {0.92 * w, 0.06, high}, lean, 0.025);
    if (random.chance(0.6)) {
        for (const double s : {-1.0, 1.0}) {
            b.box("arm", s * (w / 2 + 0.03), 0, h + 0.18, {0.06, 0.26, 0.03});
            b.box("post", s * (w / 2 + 0.02), 0, h - 0.03, {0.03, 0.05, 0.22});
        }
    }
    return b;
}

Blueprint make_work_table(Random& random) {
    Blueprint b(random.chance(0.5) ? "desk" : "table");
    const double w = random(0.8, 2.0), d = random(0.5, 0.95);
    const double h = random(0.68, 0.8), t = random(0.018, 0.05);
    const double leg = random(0.03, 0.08), over = random(0, 0.08);
    const int top = b.box("tabletop", 0, 0, h - t, {w, d, t});
    switch (random.integer(0, 3)) {
        case 0:  // cheeks and a panel
            for (const double s : {-1.0, 1.0})
                b.foot(b.box("cheek", s * (w / 2 - over - 0.01), 0, 0, {0.022, d - 0.04, h - t}));
            b.box("panel", 0, -d / 2 + 0.06, h - t - 0.4, {w - 2 * over - 0.04, 0.018, 0.4});
            break;
        case 1:  // T feet
            for (const double s : {-1.0, 1.0}) {
                const double x = s * (w / 2 - over - 0.1);
                b.foot(b.box("foot", x, 0, 0, {0.07, d - 0.06, 0.04}));
                b.box("column", x, 0, 0.04, {0.06, 0.08, h - t - 0.04});
            }
            b.box("rail", 0, 0, h - t - 0.06, {w - 2 * over - 0.2, 0.05, 0.04});
            break;
        default:
            add_legs(b, w - 2 * over, d - 2 * over, h - t, leg, random.chance(0.4));
            if (random.chance(0.6)) {
                for (const double s : {-1.0, 1.0}) {
                    b.box("apron", 0, s * (d / 2 - over - leg / 2), h - t - 0.08,
                          {w - 2 * over - leg, 0.02, 0.08});
                    b.box("apron", s * (w / 2 - over - leg / 2), 0, h - t - 0.08,
                          {0.02, d - 2 * over - leg, 0.08});
                }
            }
    }
    if (random.chance(0.25)) {  // a fixed pedestal under one end
        const double side = random.chance(0.5) ? 1 : -1;
        add_cabinet(
            b,
            {side * (w / 2 - over - leg - 0.2), -d / 2 + 0.04, 0.1, {0.36, d - 0.12, h - t - 0.1}},
            random, 0);
    }
    b.stand_on(top, 0.7, "table", 0.005);
    return b;
}

Blueprint make_drawer_unit(Random& random) {
    Blueprint b("drawer unit");
    const double w = random(0.35, 0.9), d = random(0.35, 0.55), h = random(0.4, 1.1);
    b.legs("caster", w / 2 - 0.04, d / 2 - 0.04, 0.04, 0.04, true);
    const int top = add_cabinet(b, {0, -d / 2, 0.04, {w, d - 0.02, h - 0.04}}, random, 0.15);
    b.stand_on(top, 0.5, "drawers", 0.02);
    return b;
}

Blueprint make_bookcase(Random& random, double most_height) {
    Blueprint b("bookcase");
    const double w = random(0.4, 1.4), d = random(0.22, 0.4);
    const double h = std::min(most_height, random(0.7, 2.3)), t = random(0.016, 0.03);
    const double plinth = random.chance(0.5) ? 0.06 : 0;
    const int shelves = std::max(2, static_cast<int>((h - plinth) / random(0.24, 0.42)));
    const bool back = random.chance(0.75);
    for (const double s : {-1.0, 1.0}) b.foot(b.box("side", s * (w - t) / 2, 0, 0, {t, d, h}));
    if (back) b.box("back", 0, -d / 2 + 0.004, plinth, {w - 2 * t, 0.008, h - plinth});
    if (plinth > 0) b.box("plinth", 0, d / 2 - 0.03, 0, {w - 2 * t, 0.015, plinth});
    const double pitch = (h - plinth - t) / shelves;
    for (int k = 0; k <= shelves; ++k) {
        const int board = b.box("board", 0, 0, plinth + k * pitch, {w - 2 * t, d, t});
        if (k < shelves)
            b.surfaces.push_back(
                {board, 0, 0.01, w / 2 - t - 0.004, d / 2 - 0.015, pitch - t - 0.004, "shelf"});
        else
            b.stand_on(board, 0.4, "shelf top", 0.01);
    }
    return b;
}

Blueprint make_couch(Random& random) {
    Blueprint b("sofa");
    const int seats = random.integer(1, 3);
    const double seat = random(0.52, 0.75), arm = random(0.08, 0.25);
    const double w = seats * seat + 2 * arm, d = random(0.75, 1.0);
    const double foot = random(0.02, 0.14), base = random(0.12, 0.25);
    const double back = random(0.12, 0.25), high = random(0.68, 0.95);
    b.legs("foot", w / 2 - 0.06, d / 2 - 0.06, 0.045, foot, true);
    b.box("base", 0, 0, foot, {w, d, base});
    const double top = foot + base, soft = random(0.1, 0.18);
    b.rounded("backrest", 0, -d / 2 + back / 2, top, {w, back, high - top}, 0.3 * back);
    for (const double s : {-1.0, 1.0})
        b.rounded("armrest", s * (w - arm) / 2, back / 2, top, {arm, d - back, random(0.2, 0.34)},
                  0.3 * arm);
    for (int k = 0; k < seats; ++k) {
        const double x = (k - (seats - 1) / 2.0) * seat;
        const int cushion =
            b.rounded("seat", x, back / 2, top, {seat - 0.006, d - back, soft}, 0.04);
        b.surfaces.push_back(
            {cushion, x, back / 2, seat / 2 - 0.02, (d - back) / 2 - 0.05, 0.5, "sofa"});
        if (random.chance(0.6)) {
            b.cushion("back cushion", {x, -d / 2 + back + 0.06, top + soft + 0.2},
                      {seat - 0.03, 0.12, 0.36}, random(0.05, 0.25), 0.05);
            b.surfaces.back().half_y -= 0.1;
            b.surfaces.back().y += 0.1;
        }
    }
    return b;
}

Blueprint make_tv_board(Random& random) {
    Blueprint b("low board");
    const double w = random(1.0, 2.2), d = random(0.32, 0.48), h = random(0.3, 0.7),
                 leg = random(0.04, 0.18);
    b.legs("leg", w / 2 - 0.06, d / 2 - 0.05, 0.04, leg);
    const int cells = random.integer(2, 4);
    for (int k = 0; k < cells; ++k)
        add_cabinet(b,
                    {(k + 0.5 - cells / 2.0) * w / cells,
                     -d / 2,
                     leg,
                     {w / cells, d - 0.02, h - leg - 0.02}},
                    random, 0.4);
    const int top = b.box("top", 0, 0, h - 0.02, {w, d, 0.02});
    b.stand_on(top, 1.0, "board", 0.02);
    return b;
}

Blueprint make_double_bed(Random& random) {
    Blueprint b("bed");
    const double w = random(0.85, 1.85), d = random(1.95, 2.15);
    const double leg = random(0.03, 0.25), frame = random(0.06, 0.2);
    add_legs(b, w, d, leg, 0.06, random.chance(0.5));
    b.box("frame", 0, 0, leg, {w, d, frame});
    const double soft = random(0.14, 0.28), top = leg + frame;
    const int mattress =
        b.rounded("mattress", 0, 0.01, top - 0.03, {w - 0.04, d - 0.06, soft}, 0.25 * soft);
    if (random.chance(0.8))
        b.foot(b.box("headboard", 0, -d / 2 - 0.02, 0, {w, 0.04, top + random(0.2, 0.7)}));
    if (random.chance(0.3)) b.box("footboard", 0, d / 2 + 0.015, leg, {w, 0.03, frame + soft});
    if (random.chance(0.6)) {  // a cover that hangs over the sides
        const double over = random(0.15, soft + 0.1), from = -d / 2 + random(0.4, 0.8);
        const double length = d / 2 - from, z = top - 0.03 + soft;
        b.rounded("cover", 0, from + length / 2, z - 0.01, {w + 0.04, length, 0.05}, 0.02);
        for (const double s : {-1.0, 1.0})
            b.box("cover", s * (w / 2 + 0.01), from + length / 2, z - over,
                  {0.03, length - 0.04, over});
        b.surfaces.push_back({static_cast<int>(b.parts.size()) - 3, 0, from + length / 2,
                              w / 2 - 0.2, length / 2 - 0.1, 0.6, "bed"});
        b.surfaces.push_back({mattress, 0, (-d / 2 + from) / 2, w / 2 - 0.06,
                              (from + d / 2) / 2 - 0.05, 0.5, "pillows"});
    } else {
        b.surfaces.push_back({mattress, 0, -d / 2 + 0.3, w / 2 - 0.08, 0.22, 0.5, "pillows"});
        b.surfaces.push_back({mattress, 0, 0.4, w / 2 - 0.1, 0.5, 0.5, "bed"});
    }
    return b;
}

}  // namespace topple::scenes
