// SPDX-License-Identifier: MIT
#include <algorithm>

#include "lab/furniture/blueprint.h"

namespace topple::scenes {
namespace {

constexpr double over_table = 0.60;  // free height that things on tables may take

// Legs at the corners of a w by d rectangle, under `top`, `inset` from its edges.
void four_legs(Blueprint& b, Random& random, int top, double w, double d, double height,
               double inset, double thickness) {
    b.legs("leg", w / 2 - inset - thickness / 2, d / 2 - inset - thickness / 2, thickness, height,
           random.chance(0.4), top);
}

}  // namespace

Blueprint make_table(Random& random) {
    Blueprint b("table");
    const bool low = random.chance(0.2);  // a coffee table
    const double w = random(0.9, 1.7), d = random(0.55, 0.85);
    const double h = low ? random(0.36, 0.48) : random(0.68, 0.79);
    const double t = random(0.025, 0.05), leg = random(0.045, 0.08);
    const int top = b.box("tabletop", 0, 0, h - t, {w, d, t});
    four_legs(b, random, top, w, d, h - t, random(0, 0.08), leg);
    b.stand_on(top, over_table, "table");
    return b;
}

Blueprint make_pedestal_table(Random& random) {
    Blueprint b("table");
    const double d = random(0.65, 1.05), h = random(0.68, 0.78), t = 0.035;
    const double foot = 0.035, column = random(0.08, 0.14);
    const int base = b.foot(b.cylinder("foot", 0, 0, 0, random(0.4, 0.55), foot));
    const int middle = b.cylinder("column", 0, 0, foot, column, h - t - foot);
    const int top = random.chance(0.6) ? b.cylinder("tabletop", 0, 0, h - t, d, t)
                                       : b.box("tabletop", 0, 0, h - t, {d, d, t});
    b.join(top, middle);
    b.join(middle, base);
    b.stand_on(top, over_table, "table");
    return b;
}

// Panels instead of legs, and often drawers under one end.
Blueprint make_desk(Random& random) {
    Blueprint b("desk");
    const double w = random(1.1, 1.6), d = random(0.6, 0.8);
    const double h = random(0.70, 0.76), t = 0.03, panel = 0.03;
    const int top = b.box("tabletop", 0, 0, h - t, {w, d, t});
    const int left =
        b.join(top, b.box("panel", -w / 2 + panel / 2, 0, 0, {panel, d - 0.04, h - t}));
    int right;
    if (random.chance(0.5)) {
        const double drawers = random(0.32, 0.42);
        right = b.box("drawers", w / 2 - drawers / 2, 0, 0, {drawers, d - 0.06, h - t});
    } else {
        right = b.box("panel", w / 2 - panel / 2, 0, 0, {panel, d - 0.04, h - t});
    }
    b.join(top, right);
    const double inner_low = -w / 2 + panel;
    const double inner_high = b.parts[right].bounds()[0][0];
    const double mid = (inner_low + inner_high) / 2;
    const int back =
        b.box("backboard", mid, -d / 2 + 0.05, h - t - 0.35, {inner_high - inner_low, 0.025, 0.35});
    b.join(back, left);
    b.join(back, right);
    b.join(back, top);
    b.feet = {left, right};
    b.stand_on(top, over_table, "table");
    return b;
}

Blueprint make_chair(Random& random) {
    Blueprint b("chair");
    const double w = random(0.40, 0.48), d = random(0.40, 0.47);
    const double h = random(0.42, 0.48), t = random(0.03, 0.06);
    const int seat = b.box("seat", 0, 0, h - t, {w, d, t});
    four_legs(b, random, seat, w, d, h - t, 0.005, random(0.035, 0.05));
    if (random.chance(0.6)) {
        b.join(seat, b.box("back", 0, -d / 2 + 0.02, h, {w, 0.04, random(0.36, 0.48)}));
    } else {  // two posts with a board across
        const double post = 0.035, up = random(0.22, 0.28), board = random(0.14, 0.2);
        const int rest = b.box("back", 0, -d / 2 + 0.02, h + up, {w, 0.03, board});
        for (const double sx : {-1.0, 1.0}) {
            const int p = b.join(
                seat, b.box("post", sx * (w / 2 - post), -d / 2 + 0.02, h, {post, 0.03, up}));
            b.join(p, rest);
        }
    }
    const double front = 0.025;  // things stand in front of the back
    b.surfaces.push_back({seat, 0, front, w / 2 - 0.01, d / 2 - 0.04, 0.4, "seat"});
    return b;
}

Blueprint make_stool(Random& random) {
    Blueprint b("stool");
    const double d = random(0.28, 0.38), t = 0.035;
    const double h = random.chance(0.3) ? random(0.60, 0.72) : random(0.38, 0.48);
    const int seat = b.cylinder("seat", 0, 0, h - t, d, t);
    if (random.chance(0.3)) {
        const int column = b.join(seat, b.cylinder("column", 0, 0, 0.03, 0.06, h - t - 0.03));
        b.join(column, b.foot(b.cylinder("foot", 0, 0, 0, d * 0.95, 0.03)));
    } else {
        const double leg = 0.035;
        for (const auto& [x, y] :
             {std::pair{-0.28, -0.28}, {0.28, -0.28}, {-0.28, 0.28}, {0.28, 0.28}}) {
            b.foot(b.join(seat, b.cylinder("leg", x * d, y * d, 0, leg, h - t)));
        }
    }
    b.stand_on(seat, 0.3, "seat");
    return b;
}

Blueprint make_bench(Random& random) {
    Blueprint b("bench");
    const double w = random(0.9, 1.5), d = random(0.28, 0.38);
    const double h = random(0.40, 0.47), t = random(0.035, 0.06);
    const int slab = b.box("slab", 0, 0, h - t, {w, d, t});
    const double x = w * random(0.32, 0.45);
    for (const double sx : {-1.0, 1.0}) {
        b.foot(b.join(slab, b.box("support", sx * x, 0, 0, {0.05, d * 0.9, h - t})));
    }
    b.stand_on(slab, 0.3, "bench");
    return b;
}

Blueprint make_shelf(Random& random) {
    Blueprint b("shelf");
    const double w = random(0.7, 1.15), d = random(0.26, 0.38);
    const double h = random(0.9, 1.9), t = random(0.018, 0.03);
    const int left = b.box("side", -w / 2 + t / 2, 0, 0, {t, d, h});
    const int right = b.box("side", w / 2 - t / 2, 0, 0, {t, d, h});
    b.feet = {left, right};
    const int count = std::max(3, static_cast<int>(h / random(0.33, 0.45)) + 1);
    const double low = 0.06, pitch = (h - low - t) / (count - 1);
    const bool closed = random.chance(0.5);  // with a back panel
    const double back = closed ? 0.012 : 0;
    std::vector<int> boards;
    for (int k = 0; k < count; ++k) {
        const int board = b.box("board", 0, back / 2, low + pitch * k, {w - 2 * t, d - back, t});
        b.join(board, left);
        b.join(board, right);
        boards.push_back(board);
        b.stand_on(board, k + 1 < count ? pitch - t - 0.02 : 0.3, "shelf");
    }
    if (closed) {
        const int panel = b.box("panel", 0, -d / 2 + back / 2, low, {w - 2 * t, back, h - low});
        b.join(panel, left);
        b.join(panel, right);
        for (const int board : boards) b.join(panel, board);
    }
    return b;
}

Blueprint make_dresser(Random& random) {
    Blueprint b("dresser");
    const bool small = random.chance(0.4);  // a night stand
    const double w = small ? random(0.38, 0.5) : random(0.7, 1.2);
    const double d = random(0.36, 0.5), h = small ? random(0.4, 0.6) : random(0.7, 1.1);
    const double plinth = 0.06, t = 0.03;
    const int foot = b.foot(b.box("plinth", 0, -0.02, 0, {w - 0.06, d - 0.08, plinth}));
    const int body = b.join(foot, b.box("body", 0, 0, plinth, {w, d, h - plinth - t}));
    const int top = b.join(body, b.box("top", 0, 0, h - t, {w + 0.03, d + 0.02, t}));
    b.stand_on(top, 0.5, "dresser");
    return b;
}

Blueprint make_sofa(Random& random) {
    Blueprint b("sofa");
    const bool armchair = random.chance(0.3);
    const double w = armchair ? random(0.75, 0.95) : random(1.4, 2.1);
    const double d = random(0.75, 0.92), h = random(0.38, 0.46);
    const double arm = random(0.12, 0.2), back = random(0.14, 0.22);
    const int seat = b.foot(b.box("seat", 0, 0, 0, {w, d, h}));
    const int rest =
        b.join(seat, b.box("back", 0, -d / 2 + back / 2, h, {w, back, random(0.32, 0.45)}));
    const double up = random(0.15, 0.25);
    for (const double sx : {-1.0, 1.0}) {
        const int a =
            b.join(seat, b.box("arm", sx * (w - arm) / 2, back / 2, h, {arm, d - back, up}));
        b.join(a, rest);
    }
    b.surfaces.push_back(
        {seat, 0, back / 2, w / 2 - arm - 0.01, (d - back) / 2 - 0.01, 0.4, "sofa"});
    return b;
}

Blueprint make_bed(Random& random) {
    Blueprint b("bed");
    const double w = random(0.95, 1.5), d = random(1.9, 2.05), h = random(0.42, 0.55);
    const int frame = b.box("frame", 0, 0, 0, {w, d, h});
    const int head = b.join(
        frame, b.box("headboard", 0, -d / 2 - 0.025, 0, {w + 0.06, 0.05, random(0.85, 1.1)}));
    b.feet = {frame, head};
    b.surfaces.push_back({frame, 0, -d / 2 + 0.35, w / 2 - 0.05, 0.28, 0.4, "bed"});
    return b;
}

Blueprint make_wall_cabinet(Random& random) {
    Blueprint b("wall cabinet");
    const double w = random(0.6, 1.1), d = random(0.26, 0.36), h = random(0.4, 0.7);
    const int body = b.box("cabinet", 0, 0, 0, {w, d, h});
    if (random.chance(0.5)) {  // two doors that stand proud of the body
        for (const double sx : {-1.0, 1.0}) {
            b.join(body,
                   b.box("door", sx * w / 4, d / 2 + 0.01, 0.01, {w / 2 - 0.02, 0.02, h - 0.02}));
        }
    }
    b.wall_parts = {body};
    return b;
}

Blueprint make_wall_shelf(Random& random) {
    Blueprint b("wall shelf");
    const int board = b.box("board", 0, 0, 0, {random(0.6, 1.1), random(0.2, 0.26), 0.03});
    b.wall_parts = {board};
    b.stand_on(board, 0.35, "wall-shelf");
    return b;
}

Blueprint make_floor_lamp(Random& random) {
    Blueprint b("floor lamp");
    const double base = random(0.26, 0.34), pole = random(1.15, 1.4), shade = random(0.22, 0.3);
    const int foot = b.foot(b.cylinder("base", 0, 0, 0, base, 0.03));
    const int stem = b.join(foot, b.cylinder("pole", 0, 0, 0.03, 0.035, pole));
    b.join(stem, b.cone("shade", 0, 0, 0.03 + pole, random(0.32, 0.42), shade, random(0.5, 0.8)));
    return b;
}

Blueprint make_plant(Random& random) {
    Blueprint b("plant");
    const double pot = random(0.2, 0.3), h = random(0.22, 0.32), trunk = random(0.25, 0.5);
    const int base = b.foot(b.cone("pot", 0, 0, 0, pot, h, random(1.15, 1.4)));
    const int stem = b.join(base, b.cylinder("trunk", 0, 0, h, random(0.03, 0.05), trunk));
    const double crown = random(0.32, 0.5);
    b.join(stem, b.cone("crown", 0, 0, h + trunk, crown, random(0.35, 0.6), random(0.0, 0.9)));
    return b;
}

Blueprint make_bin(Random& random) {
    Blueprint b("bin");
    const double d = random(0.2, 0.28), h = random(0.26, 0.42);
    const int body = random.chance(0.5) ? b.cone("bin", 0, 0, 0, d, h, random(1.1, 1.3))
                                        : b.cylinder("bin", 0, 0, 0, d, h);
    b.foot(body);
    return b;
}

Blueprint make_crate(Random& random) {
    Blueprint b =
        lone_box("crate", "crate", {random(0.28, 0.55), random(0.25, 0.4), random(0.2, 0.45)});
    b.stand_on(0, 0.35, "crate");
    return b;
}

Blueprint make_roll(Random& random) {
    Blueprint b("roll");
    b.foot(b.lying("roll", 0, 0, 0, random(0.5, 1.0), random(0.12, 0.22)));
    return b;
}

Blueprint make_marker(Random& random) {
    Blueprint b("marker");
    const double w = random(0.24, 0.32);
    const int base = b.foot(b.box("base", 0, 0, 0, {w, w, 0.03}));
    b.join(base, b.cone("cone", 0, 0, 0.03, w * 0.8, random(0.32, 0.5), random(0.1, 0.25)));
    return b;
}

}  // namespace topple::scenes
