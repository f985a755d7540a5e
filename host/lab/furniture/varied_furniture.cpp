// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "lab/furniture/profiles.h"
#include "lab/furniture/varied.h"

namespace topple::scenes {
namespace {

constexpr double over_varied_table = 0.60;  // free height that things on tables may take

}  // namespace

Blueprint make_splayed_table(Random& random) {
    Blueprint b("table");
    const bool low = random.chance(0.3);
    const double w = random(0.8, 1.5), d = random(0.6, 0.85);
    const double h = low ? random(0.36, 0.48) : random(0.7, 0.78);
    const double t = random(0.03, 0.055), lean = random(0.08, 0.2);
    const int top = b.rounded("tabletop", 0, 0, h - t, {w, d, t}, 0.45 * t);
    const double thick = random(0.04, 0.06);
    for (const auto [sx, sy] : corners) {
        const double x = sx * 0.36 * w, y = sy * 0.34 * d;
        b.foot(b.join(top, b.leg("leg", x, y, 0, h - t, thick, lean, std::atan2(y, x))));
    }
    b.stand_on(top, over_varied_table, "table", 0.03);
    return b;
}

// One turned body: wide at the foot and the top.
Blueprint make_drum_table(Random& random) {
    const double r = random(0.2, 0.3), h = random(0.42, 0.6);
    const double waist = r * random(0.35, 0.9), top = r * random(0.9, 1.2);
    Blueprint b = lone_revolved("side table", "body",
                                solid_within(smooth_side({r, 0.9 * r, waist, waist, top, top}, h)));
    b.surfaces.push_back({0, 0, 0, 0.65 * top, 0.65 * top, over_varied_table, "table"});
    return b;
}

// A frame on legs, a mattress on the frame; pillows are objects of their own.
Blueprint make_made_bed(Random& random) {
    Blueprint b("bed");
    const double w = random(0.95, 1.6), d = random(1.95, 2.1);
    const double leg = random(0.1, 0.22), frame = random(0.08, 0.16);
    const double soft = random(0.14, 0.22), top = leg + frame;
    const int board = b.box("frame", 0, 0, leg, {w, d, frame});
    b.legs("foot", w / 2 - 0.05, d / 2 - 0.05, 0.07, leg, false, board);
    const int mattress =
        b.join(board, b.rounded("mattress", 0, 0, top, {w - 0.05, d - 0.05, soft}, 0.3 * soft));
    b.foot(b.join(
        board, b.box("headboard", 0, -d / 2 - 0.02, 0, {w + 0.04, 0.04, top + random(0.45, 0.7)})));
    b.surfaces.push_back({mattress, 0, -d / 2 + 0.32, w / 2 - 0.1, 0.22, 0.4, "bed"});
    b.surfaces.push_back({mattress, 0, 0.3, w / 2 - 0.1, 0.4, 0.4, "bed"});
    return b;
}

// High enough to stand under; a ladder leans against its front and is fixed there.
Blueprint make_loft_bed(Random& random) {
    Blueprint b("loft bed");
    const double w = random(1.9, 2.05), d = random(0.85, 1.0);
    const double under = random(1.3, 1.55), t = 0.05, post = 0.07;
    const int slab = b.box("slab", 0, 0, under, {w, d, t});
    b.legs("post", (w - post) / 2, (d - post) / 2, post, under, false, slab);
    b.join(slab, b.rounded("mattress", 0, -0.08, under + t, {w - 0.1, d - 0.2, 0.14}, 0.04));
    // A stringer's back touches the slab's upper front edge, a thickness below its own end.
    const double lean = random(0.18, 0.26), width = 0.4, thick = 0.03, deep = 0.07;
    const double x = random.chance(0.5) ? -0.25 * w : 0.25 * w;
    const double foot_y = d / 2 + (under + t) * std::tan(lean);
    const double length = (under + t + 0.04) / std::cos(lean);
    for (const double sx : {-1.0, 1.0}) {
        b.foot(b.join(slab, b.leaning("stringer", x + sx * (width - thick) / 2, foot_y, 0,
                                      {thick, deep, length}, lean)));
    }
    const int left = b.feet[b.feet.size() - 2], right = b.feet.back();
    b.rungs(left, right, static_cast<int>(length / 0.28), 0.035);
    return b;
}

Blueprint make_wardrobe(Random& random) {
    Blueprint b("wardrobe");
    const double w = random(0.8, 1.3), d = random(0.5, 0.62);
    const double h = random(1.6, 2.05), plinth = 0.08, t = 0.022;
    const int foot = b.foot(b.box("plinth", 0, -0.02, 0, {w - 0.04, d - 0.08, plinth}));
    const int body = b.join(foot, b.box("body", 0, 0, plinth, {w, d, h - plinth}));
    // Doors hang on the outer edges of the front; one may be ajar.
    const int ajar = random.integer(0, 2);
    for (int k = 0; k < 2; ++k) {
        const double side = k == 0 ? -1 : 1, width = w / 2 - 0.006;
        const double open = k == ajar ? random(0.3, 1.3) : 0;
        // The door's middle seen from its hinge, before it opens.
        const Pose hinge{side * w / 2, d / 2, 0, -side * open};
        const Vec3 middle = moved(hinge, Vec3{-side * width / 2, t / 2, 0});
        const int door = b.box("door", middle[0], middle[1], plinth + 0.02,
                               {width, t, h - plinth - 0.04}, -side * open);
        b.parts[door].opening = hinge_at(side);
        b.join(body, door);
    }
    b.surfaces.push_back({body, 0, 0, w / 2 - 0.02, d / 2 - 0.03, 0.3, "wardrobe"});
    return b;
}

// Boards with dividers between them.
Blueprint make_cube_shelf(Random& random) {
    Blueprint b("cube shelf");
    const int columns = random.integer(2, 3), rows = random.integer(2, 4);
    const double cell = random(0.32, 0.4), t = random(0.02, 0.035);
    const double d = random(0.32, 0.4), w = columns * cell + t;
    std::vector<int> boards;
    for (int row = 0; row <= rows; ++row) {
        const int board = b.box("board", 0, 0, row * cell, {w, d, t});
        boards.push_back(board);
        if (row == 0) b.foot(board);
        for (int c = 0; c <= columns && row > 0; ++c) {
            const int wall = b.box("divider", -w / 2 + t / 2 + c * cell, 0, (row - 1) * cell + t,
                                   {t, d, cell - t});
            b.join(wall, boards[static_cast<std::size_t>(row) - 1]);
            b.join(wall, board);
        }
    }
    for (int row = 0; row < rows; ++row) {
        for (int c = 0; c < columns; ++c) {
            b.surfaces.push_back({boards[row], -w / 2 + t / 2 + (c + 0.5) * cell, 0,
                                  (cell - t) / 2 - 0.015, d / 2 - 0.01, cell - t - 0.02, "shelf"});
        }
    }
    b.stand_on(boards.back(), 0.4, "shelf");
    return b;
}

// A raised floor with a step in front of it.
Blueprint make_podium(Random& random) {
    Blueprint b("podium");
    const double w = random(1.6, 2.3), d = random(1.0, 1.4), h = random(0.24, 0.42), run = 0.28;
    const int floor = b.box("platform", 0, 0, 0, {w, d, h});
    const int step =
        b.join(floor, b.box("step", random(-0.3, 0.3), (d + run) / 2, 0, {0.7, run, h / 2}));
    b.feet = {floor, step};
    b.stand_on(floor, 1.2, "podium");
    return b;
}

// A flight of solid steps along a wall, up to a landing.
Blueprint make_stairs(Random& random) {
    Blueprint b("stairs");
    const int steps = random.integer(3, 5);
    const double rise = random(0.15, 0.2), run = random(0.25, 0.3);
    const double d = random(0.7, 0.9), landing = random(0.5, 0.8);
    const double side = random.chance(0.5) ? 1 : -1, length = steps * run + landing;
    for (int k = 0; k <= steps; ++k) {
        const bool last = k == steps;
        const double deep = last ? landing : run;
        const double from = -length / 2 + k * run;
        const int step = b.foot(b.box(last ? "landing" : "step", side * (from + deep / 2), 0, 0,
                                      {deep, d, (k + 1) * rise}));
        if (k > 0) b.join(step, step - 1);
        b.stand_on(step, last ? 0.5 : 0.25, "stairs", 0.02);
    }
    return b;
}

}  // namespace topple::scenes
