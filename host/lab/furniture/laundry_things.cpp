// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numbers>

#include "lab/furniture/things.h"

namespace topple::scenes {

Blueprint make_washer(Random& random, const Vec3& size) {
    Blueprint b(random.chance(0.5) ? "washing machine" : "dryer");
    const auto [w, d, h] = size;
    const int body = b.foot(b.box("body", 0, 0, 0, {w, d, h}));
    if (random.chance(0.75)) {
        const double across = random(0.5, 0.75) * w;
        b.lying("door", 0, d / 2 + 0.005, 0.42 * h - across / 2, 0.03, across,
                std::numbers::pi / 2);
    } else {
        b.box("lid", 0, 0.05, h, {0.8 * w, 0.6 * d, 0.015});
        b.box("console", 0, -d / 2 + 0.05, h, {w, 0.1, random(0.08, 0.18)});
        return b;
    }
    b.box("console", 0, d / 2 + 0.006, 0.86 * h, {w - 0.01, 0.02, 0.13 * h});
    b.lying("knob", 0.3 * w, d / 2 + 0.025, 0.9 * h, 0.03, 0.05, std::numbers::pi / 2);
    b.stand_on(body, 1.0, "appliance", 0.01);
    return b;
}

Blueprint make_ironing_board(Random& random) {
    Blueprint b("ironing board");
    const double h = random(0.75, 0.95), length = random(1.1, 1.35), w = 0.36;
    const int top = b.box("board", -0.06, 0, h - 0.03, {length - 0.12, w, 0.03});
    b.cylinder("nose", length / 2 - 0.16, 0, h - 0.03, 0.8 * w, 0.03);
    for (const double s : {-1.0, 1.0}) {
        b.bar("leg", {s * 0.4, 0.0, 0.03}, {-s * 0.35, 0.0, h - 0.03}, 0.025);
        b.foot(b.lying("foot", s * 0.4, 0, 0, 0.44, 0.03, std::numbers::pi / 2));
    }
    b.surfaces.push_back({top, -0.06, 0, length / 2 - 0.12, w / 2 - 0.03, 0.4, "board"});
    return b;
}

Blueprint make_drying_rack(Random& random) {
    Blueprint b("drying rack");
    const double w = random(0.7, 1.2), d = random(0.45, 0.6), h = random(0.85, 1.1), t = 0.018;
    for (const double s : {-1.0, 1.0}) {
        for (const double e : {-1.0, 1.0}) b.foot(b.box("leg", s * w / 2, e * d / 2, 0, {t, t, h}));
        b.box("rail", s * w / 2, 0, h - t, {t, d, t});
    }
    for (int k = 0; k < 6; ++k) {
        const double y = (k - 2.5) * d / 6;
        b.lying("bar", 0, y, h - t, w, 0.01);
        if (!random.chance(0.6)) continue;
        const double wide = random(0.2, 0.45) * w, low = random(0.2, 0.6) * h;
        b.rounded("cloth", random(-0.25, 0.25) * w, y, h - low, {wide, 0.03, low}, 0.012);
    }
    return b;
}

Blueprint make_pallet_jack(Random& random) {
    Blueprint b("pallet jack");
    const double length = 1.15, high = random(0.05, 0.1);
    for (const double s : {-1.0, 1.0}) {
        b.box("fork", s * 0.19, 0, high - 0.05 + 0.03, {0.16, length, 0.05});
        b.foot(b.lying("wheel", s * 0.19, length / 2 - 0.12, 0, 0.07, 0.08));
    }
    b.box("body", 0, -length / 2 - 0.06, 0.06, {0.5, 0.14, 0.4});
    b.foot(b.lying("wheel", 0, -length / 2 - 0.1, 0, 0.2, 0.16));
    b.bar("tiller", {0, -length / 2 - 0.08, 0.4}, {0, -length / 2 - random(0.1, 0.4), 1.15}, 0.04);
    return b;
}

}  // namespace topple::scenes
