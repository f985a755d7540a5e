// SPDX-License-Identifier: MIT
#include <algorithm>

#include "lab/furniture/things.h"
#include "lab/furniture/varied.h"

namespace topple::scenes {
namespace {

// Rounded slabs that overlap at different heights: one soft, uneven body over a rectangle.
void add_folds(Blueprint& b, const char* part, double x, double y, double bottom, const Vec3& size,
               int nx, int ny, Random& random) {
    for (int k = 0; k < nx * ny; ++k) {
        const double w = size[0] / nx, d = size[1] / ny;
        const double t = size[2] * random(0.6, 1);
        const double wide = std::min(w * random(1.0, 1.3), size[0]),
                     deep = std::min(d * random(1.0, 1.3), size[1]);
        const double most_x = (size[0] - wide) / 2, most_y = (size[1] - deep) / 2;
        const double px = std::clamp((k % nx + 0.5) * w - size[0] / 2, -most_x, most_x),
                     py = std::clamp((k / nx + 0.5) * d - size[1] / 2, -most_y, most_y);
        b.rounded(part, x + px, y + py, bottom, {wide, deep, t}, 0.45 * t);
    }
}

void add_seat(Blueprint& b, double x, double y, double w, double d, double foot, double top,
              Random& random) {
    b.box("base", x, y, foot, {w, d, top - foot - 0.1});
    const int cushion =
        b.rounded("seat", x, y, top - 0.12, {w - 0.006, d - 0.006, 0.12}, random(0.02, 0.05));
    b.surfaces.push_back({cushion, x, y, w / 2 - 0.03, d / 2 - 0.06, 0.5, "sofa"});
}

Blueprint backpack(Random& random) {
    Blueprint b(random.chance(0.5) ? "backpack" : "bag");
    const double w = random(0.24, 0.42), d = random(0.12, 0.25), h = random(0.28, 0.52);
    b.foot(b.rounded("body", 0, 0, 0, {w, d, h}, 0.35 * d));
    b.rounded("pocket", 0, d / 2, 0.01, {0.8 * w, 0.1, 0.5 * h}, 0.04);
    for (const double s : {-1.0, 1.0})
        b.box("strap", s * 0.25 * w, -d / 2 - 0.012, 0.1, {0.05, 0.03, 0.7 * h});
    return b;
}

Blueprint cloth_pile(Random& random) {
    Blueprint b("clothes");
    const double w = random(0.3, 0.8), d = random(0.25, 0.6);
    b.foot(b.rounded("cloth", 0, 0, 0, {w, d, 0.06}, 0.028));
    for (int k = random.integer(3, 7); k > 0; --k) {
        const double t = random(0.07, 0.22), s = random(0.35, 0.6);
        b.rounded("cloth", random(-0.2, 0.2) * w, random(-0.2, 0.2) * d, 0.01, {s * w, s * d, t},
                  0.4 * std::min(t, s * d));
    }
    return b;
}

}  // namespace

Blueprint make_corner_sofa(Random& random) {
    Blueprint b("sofa");
    const int seats = random.integer(2, 4);
    const double seat = random(0.55, 0.8), deep = random(0.6, 0.8);
    const double back = random(0.14, 0.26), foot = random(0.02, 0.12);
    const double top = random(0.36, 0.46), high = random(0.65, 0.9);
    const double w = seats * seat, side = random.chance(0.5) ? 1 : -1;
    const double chaise = random(0.5, 1.3);
    for (int k = 0; k < seats; ++k)
        add_seat(b, (k - (seats - 1) / 2.0) * seat, 0, seat, deep, foot, top, random);
    const double end = side * (w - seat) / 2;
    add_seat(b, end, (deep + chaise) / 2, seat, chaise, foot, top, random);
    b.rounded("backrest", 0, -(deep + back) / 2, foot, {w, back, high - foot}, 0.3 * back);
    if (random.chance(0.5))
        b.rounded("backrest", side * (w + back) / 2, (chaise - back) / 2, foot,
                  {back, deep + chaise + back, high - foot}, 0.3 * back);
    if (random.chance(0.6))
        b.rounded("armrest", -side * (w / 2 + 0.08), -back / 2, foot,
                  {0.16, deep + back, top + 0.18 - foot}, 0.05);
    b.legs("foot", w / 2 - 0.08, deep / 2 - 0.06, 0.05, foot + 0.001, true);
    b.foot(b.cylinder("foot", end, deep / 2 + chaise - 0.08, 0, 0.05, foot + 0.001));
    return b;
}

Blueprint make_ottoman(Random& random) {
    Blueprint b("ottoman");
    const double w = random(0.4, 1.1), d = random(0.4, 0.7), h = random(0.32, 0.48);
    b.foot(b.box("base", 0, 0, 0, {w - 0.01, d - 0.01, h - 0.08}));
    const int top = b.rounded("seat", 0, 0, h - 0.1, {w, d, 0.1}, 0.03);
    b.stand_on(top, 0.6, "ottoman", 0.05);
    return b;
}

Blueprint make_wall_curtain(Random& random, double length, double height) {
    Blueprint b("curtain");
    const double fold = random(0.05, 0.12), deep = random(0.04, 0.1);
    const double low = random.chance(0.5) ? 0.01 : random(0.02, 0.7);
    const int folds = std::max(2, static_cast<int>(length / fold));
    b.lying("rail", 0, deep / 2 + 0.012, height - 0.03, length, 0.025);
    for (int k = 0; k < folds; ++k) {
        const double x = (k + 0.5 - folds / 2.0) * fold, turn = k % 2 == 0 ? 0.6 : -0.6;
        b.box("fold", x, deep / 2 + 0.012, low, {fold * 1.15, 0.012, height - low - 0.02}, turn);
    }
    // What hangs close to the wall holds it there.
    b.box("bracket", 0, -0.02, height - 0.04, {0.03, deep / 2 + 0.04, 0.03});
    return b;
}

Blueprint make_soft_bed(Random& random) {
    Blueprint b("bed");
    const double w = random(0.8, 2.0), d = random(1.9, 2.15);
    const double low = random.chance(0.4) ? 0.02 : random(0.08, 0.25), frame = random(0.1, 0.25),
                 soft = random(0.14, 0.3);
    b.legs("leg", w / 2 - 0.06, d / 2 - 0.06, 0.07, low + 0.001);
    b.box("frame", 0, 0, low, {w, d, frame});
    const double top = low + frame + soft - 0.03;
    b.rounded("mattress", 0, 0, low + frame - 0.03, {w - 0.02, d - 0.02, soft}, 0.06);
    if (random.chance(0.8))
        b.box("headboard", 0, -d / 2 - 0.03, 0.01,
              {w + random(0, 0.2), 0.06, top + random(0.1, 0.8)});
    // The duvet, perhaps thrown back, hangs over the sides.
    const double from = -d / 2 + random(0.4, 1.0), length = d / 2 - from;
    const double over = random(0, 0.12), y = from + length / 2;
    add_folds(b, "duvet", 0, y, top - 0.02, {w + over, length, random(0.08, 0.2)},
              random.integer(2, 4), random.integer(2, 4), random);
    if (over > 0.04) {
        for (const double s : {-1.0, 1.0})
            b.rounded("duvet", s * (w / 2 + 0.015), y, low + random(0.05, frame),
                      {0.06, 0.95 * length, top - low - frame}, 0.025);
    }
    const int pillows = w > 1.2 ? 2 : 1;
    for (int k = 0; k < pillows; ++k)  // of one piece with the bed for all who look
        b.rounded("pillow", (k - (pillows - 1) / 2.0) * w / 2, -d / 2 + 0.25, top - 0.02,
                  {random(0.4, 0.6), 0.38, random(0.1, 0.18)}, 0.045);
    return b;
}

Stack make_floor_thing(Random& random, double clearance) {
    const auto carton = [](Random& r) { return make_carton(r, r(0.2, 0.7)); };
    const Blueprint b = one_of(
        random, {backpack, backpack, cloth_pile, carton, make_basket, make_open_bin, make_bag});
    return b.height() < clearance ? Stack{b} : Stack{};
}

}  // namespace topple::scenes
