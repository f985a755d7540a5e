// SPDX-License-Identifier: MIT
#include <numbers>

#include "lab/furniture/profiles.h"
#include "lab/furniture/things.h"
#include "lab/furniture/varied.h"

namespace topple::scenes {
namespace {

Blueprint soap_bottle(Random& random) {
    Blueprint b("bottle");
    const double w = random(0.04, 0.08), h = random(0.12, 0.24);
    b.foot(b.rounded("body", 0, 0, 0, {w, 0.7 * w, h}, 0.012));
    b.cylinder("cap", 0, 0, h, 0.5 * w, 0.03);
    return b;
}

Stack towels(Random& random) {
    Stack stack;
    for (int k = random.integer(1, 4); k > 0; --k) {
        const Vec3 size{random(0.24, 0.3), random(0.18, 0.24), random(0.03, 0.06)};
        stack.push_back(lone_rounded("towel", "towel", size, 0.012));
    }
    return stack;
}

Blueprint paper_roll(Random&) {
    Blueprint b("roll");
    b.foot(b.cylinder("roll", 0, 0, 0, 0.11, 0.1));
    return b;
}

}  // namespace

Blueprint make_basin(Random& random) {
    Blueprint b("basin");
    const double w = random(0.4, 0.7), d = random(0.34, 0.5), h = 0.85, t = 0.03;
    if (random.chance(0.5)) {
        b.cylinder("column", 0, d / 2, 0, 0.18, h - 0.16);
    } else {
        add_cabinet(b, {0, 0, 0.15, {w, d - 0.03, h - 0.31}}, random, 0.1);
    }
    b.box("floor", 0, d / 2, h - 0.16, {w, d, t});
    for (const double s : {-1.0, 1.0}) {
        b.box("rim", s * (w - 0.05) / 2, d / 2, h - 0.13, {0.05, d, 0.13});
        b.box("rim", 0, s < 0 ? 0.05 : d - 0.025, h - 0.13, {w - 0.1, s < 0 ? 0.1 : 0.05, 0.13});
    }
    b.cylinder("tap", 0, 0.05, h, 0.03, 0.12);
    b.box("tap", 0, 0.1, h + 0.1, {0.02, 0.12, 0.02});
    return b;
}

Blueprint make_toilet(Random& random) {
    Blueprint b("toilet");
    const double h = random(0.38, 0.44), r = random(0.17, 0.2);
    b.revolved("bowl", 0, 0.42, 0, solid_within(smooth_side({0.7 * r, 0.6 * r, r, r}, h)));
    b.box("neck", 0, 0.2, 0, {0.2, 0.26, h - 0.02});
    b.cylinder("seat", 0, 0.42, h, 2.1 * r, 0.035);
    if (random.chance(0.7)) {
        b.rounded("tank", 0, 0.09, h - 0.02, {random(0.34, 0.42), 0.17, 0.36}, 0.03);
        if (random.chance(0.4)) b.leaning("lid", 0, 0.24, h + 0.03, {1.9 * r, 0.02, 0.38}, 0.15);
    }
    b.box("mount", 0, 0.05, 0.1, {0.2, 0.1, 0.2});
    return b;
}

Blueprint make_bath(Random& random) {
    if (random.chance(0.4)) {
        Blueprint b("shower");
        const double w = random(0.75, 1.0);
        b.box("tray", 0, w / 2, 0, {w, w, random(0.03, 0.12)});
        if (random.chance(0.7)) b.box("glass", w / 2 - 0.01, w / 2, 0.1, {0.02, w, 1.85});
        b.cylinder("column", 0, 0.03, 0.9, 0.025, 1.1);
        b.cylinder("head", 0, 0.15, 1.95, 0.2, 0.02);
        b.box("arm", 0, 0.08, 1.97, {0.02, 0.16, 0.02});
        return b;
    }
    Blueprint b("tub");
    const double l = random(1.4, 1.8), w = random(0.65, 0.8), h = random(0.5, 0.62),
                 t = random(0.05, 0.1);
    b.box("floor", 0, w / 2, 0, {l, w, 0.15});
    for (const double s : {-1.0, 1.0}) {
        b.box("rim", s * (l - t) / 2, w / 2, 0.15, {t, w, h - 0.15});
        b.box("rim", 0, w / 2 + s * (w - t) / 2, 0.15, {l - 2 * t, t, h - 0.15});
    }
    b.cylinder("tap", 0.3 * l, 0.04, h, 0.03, 0.1);
    return b;
}

Blueprint make_towel_rail(Random& random) {
    Blueprint b("towel rail");
    const double w = random(0.4, 0.7);
    b.lying("rail", 0, 0.08, 0, w, 0.02);
    for (const double s : {-0.45, 0.45}) b.box("mount", s * w, 0.04, 0, {0.02, 0.08, 0.02});
    const double cloth = w * random(0.4, 0.8), drop = random(0.3, 0.7);
    b.box("towel", 0, 0.095, 0.02 - drop, {cloth, 0.008, drop});
    b.box("towel", 0, 0.065, 0.02 - 0.8 * drop, {cloth, 0.008, 0.8 * drop});
    return b;
}

Stack make_bath_item(Random& random, double clearance) {
    return any_that_fits(random, clearance,
                         {soap_bottle, towels, paper_roll, make_turned_item, make_turned_item});
}

Stack make_turned_item(Random& random, double clearance) {
    for (int attempt = 0; attempt < 6; ++attempt) {
        const Group group = make_varied_item(random, clearance, 0.35);
        if (group.size() == 1) return {group.front().blueprint};
        Stack stack = make_item(random, clearance, 0.35);
        if (stack.size() == 1) return stack;
    }
    return {};
}

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

}  // namespace topple::scenes
