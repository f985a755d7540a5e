// SPDX-License-Identifier: MIT
#include <cmath>

#include "lab/furniture/things.h"

namespace topple::scenes {

Blueprint make_stacking_chair(Random& random) {
    Blueprint b("chair");
    const double w = random(0.4, 0.52), d = random(0.38, 0.48), h = random(0.42, 0.48),
                 tube = random(0.018, 0.028);
    const double lean = random(0.05, 0.25), high = random(0.28, 0.45);
    b.rounded("seat", 0, 0, h - 0.03, {w, d, 0.03}, 0.012);
    const bool sled = random.chance(0.4);
    for (const double s : {-1.0, 1.0}) {
        const double x = s * (w / 2 - 0.02);
        if (sled) {
            b.foot(b.box("runner", x, 0, 0, {tube, d, tube}));
            b.bar("tube", {x, d / 2 - tube, 0.01}, {x, d / 2 - 0.05, h - 0.02}, tube);
            b.bar("tube", {x, -d / 2 + tube, 0.01}, {x, -d / 2 + 0.05, h - 0.02}, tube);
        } else {
            b.foot(b.box("leg", x, d / 2 - tube, 0, {tube, tube, h - 0.03}));
            b.foot(b.box("leg", x, -d / 2 + tube, 0, {tube, tube, h - 0.03}));
        }
        b.bar("tube", {0.9 * x, -d / 2 + 0.03, h - 0.02},
              {0.9 * x, -d / 2 + 0.03 - (high + 0.1) * std::tan(lean), h + high + 0.1}, tube);
    }
    b.cushion("back", {0, -d / 2 + 0.04 - std::sin(lean) * (0.12 + high / 2), h + 0.12 + high / 2},
              {0.95 * w, 0.03, high}, lean, 0.012);
    if (random.chance(0.25)) {  // a board to write on
        b.box("post", w / 2 - 0.01, 0.05, h - 0.02, {0.025, 0.025, 0.22});
        b.box("tablet", w / 2 - 0.08, 0.14, h + 0.2, {0.26, 0.36, 0.016});
    } else if (random.chance(0.35)) {
        for (const double s : {-1.0, 1.0}) {
            b.box("arm", s * w / 2, -0.02, h + 0.2, {0.045, 0.3, 0.025});
            b.box("post", s * w / 2, 0.08, h - 0.025, {0.022, 0.022, 0.23});
        }
    }
    return b;
}

Blueprint make_lectern(Random& random) {
    Blueprint b("lectern");
    const double w = random(0.45, 0.8), d = random(0.35, 0.55), h = random(0.95, 1.15);
    if (random.chance(0.6)) {
        b.foot(b.box("body", 0, 0, 0, {w, d, h}));
    } else {
        b.foot(b.box("base", 0, 0, 0, {w, d, 0.04}));
        b.box("column", 0, 0, 0.04, {0.2, 0.12, h - 0.04});
    }
    b.leaning("board", 0, -d / 2 + 0.02, h - 0.005, {w, 0.025, d}, 1.3);
    return b;
}

Blueprint make_wall_board(Random& random, double length) {
    Blueprint b("board");
    const double h = random(0.8, 1.3), t = random(0.015, 0.04);
    b.box("board", 0, 0, 0, {length, t, h});
    for (const double z : {0.0, h - 0.03})
        b.box("rim", 0, 0.006, z, {length + 0.02, t + 0.012, 0.03});
    for (const double s : {-1.0, 1.0}) b.box("rim", s * length / 2, 0.006, 0, {0.03, t + 0.012, h});
    if (random.chance(0.6)) b.box("tray", 0, t / 2 + 0.035, -0.012, {0.7 * length, 0.07, 0.015});
    for (Part& part : b.parts) part.center[1] += 0.05;  // backs of all in one plane
    const double back = b.back();
    for (Part& part : b.parts) part.center[1] -= back;
    return b;
}

Blueprint make_projection_screen(Random& random, double length) {
    Blueprint b("screen");
    const double h = random(0.6, 0.8) * length;
    b.box("case", 0, 0.05, h, {length + 0.12, 0.1, 0.1});
    b.box("cloth", 0, 0.05, 0.02, {length, 0.004, h});
    b.lying("bar", 0, 0.05, 0, length, 0.025);
    return b;
}

Blueprint make_board_on_wheels(Random& random) {
    Blueprint b("board");
    const double w = random(0.9, 1.9), low = random(0.6, 0.85), h = random(0.9, 1.2);
    for (const double s : {-1.0, 1.0}) {
        b.foot(b.box("foot", s * (w / 2 + 0.02), 0, 0, {0.04, 0.55, 0.06}));
        b.box("post", s * (w / 2 + 0.02), 0, 0.06, {0.04, 0.04, low + h - 0.06});
    }
    b.box("panel", 0, 0, low, {w, 0.03, h});
    b.box("rail", 0, 0, 0.25, {w, 0.03, 0.03});
    if (random.chance(0.6)) b.box("tray", 0, 0.05, low - 0.01, {0.7 * w, 0.1, 0.015});
    return b;
}

}  // namespace topple::scenes
