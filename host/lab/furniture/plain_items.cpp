// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "lab/furniture/blueprint.h"

namespace topple::scenes {
namespace {

Blueprint cup(Random& random) {
    Blueprint b("cup");
    const double d = random(0.07, 0.1), h = random(0.08, 0.13);
    b.foot(random.chance(0.5) ? b.cylinder("cup", 0, 0, 0, d, h)
                              : b.cone("cup", 0, 0, 0, d, h, random(1.05, 1.25)));
    return b;
}

Blueprint bottle(Random& random) {
    Blueprint b("bottle");
    const double d = random(0.065, 0.1), h = random(0.17, 0.24);
    const int body = b.foot(b.cylinder("body", 0, 0, 0, d, h));
    if (random.chance(0.5)) b.join(body, b.cylinder("neck", 0, 0, h, 0.4 * d, random(0.05, 0.09)));
    return b;
}

Blueprint lying_bottle(Random& random) {
    Blueprint b("lying bottle");
    b.foot(b.lying("body", 0, 0, 0, random(0.18, 0.28), random(0.065, 0.09)));
    return b;
}

Blueprint ball(Random& random) {
    Blueprint b("ball");
    b.foot(b.sphere("ball", 0, 0, 0, random(0.1, 0.2)));
    return b;
}

Blueprint plain_carton(Random& random) {
    return lone_box("box", "box", {random(0.12, 0.28), random(0.1, 0.2), random(0.07, 0.26)});
}

Blueprint vase(Random& random) {
    Blueprint b("vase");
    const double d = random(0.06, 0.09), belly = random(1.5, 2.1);
    const double low = random(0.09, 0.14), high = random(0.08, 0.14);
    const int base = b.foot(b.cone("lower", 0, 0, 0, d, low, belly));
    b.join(base, b.cone("upper", 0, 0, low, d * belly, high, random(0.35, 0.6)));
    return b;
}

Blueprint pyramid(Random& random) {
    Blueprint b("cone");
    b.foot(b.cone("cone", 0, 0, 0, random(0.12, 0.18), random(0.16, 0.26),
                  random.chance(0.5) ? 0.0 : random(0.1, 0.4)));
    return b;
}

Blueprint plain_desk_lamp(Random& random) {
    Blueprint b("lamp");
    const double pole = random(0.2, 0.3), shade = random(0.12, 0.17);
    const int base = b.foot(b.cylinder("base", 0, 0, 0, random(0.13, 0.18), 0.025));
    const int stem = b.join(base, b.cylinder("pole", 0, 0, 0.025, random(0.02, 0.035), pole));
    b.join(stem, b.cone("shade", 0, 0, 0.025 + pole, random(0.2, 0.26), shade, random(0.45, 1.0)));
    return b;
}

Blueprint monitor(Random& random) {
    Blueprint b("monitor");
    const double w = random(0.42, 0.62), h = w * random(0.55, 0.65), t = random(0.03, 0.05);
    const double up = random(0.1, 0.16), foot = 0.02, neck = 0.045;
    const int base = b.foot(b.box("base", 0, 0, 0, {random(0.2, 0.28), 0.18, foot}));
    const int stem = b.join(base, b.box("neck", 0, -0.03, foot, {0.07, neck, up + 0.5 * h - foot}));
    b.join(stem, b.box("panel", 0, -0.03 + (neck + t) / 2, up, {w, t, h}));
    return b;
}

Blueprint laptop(Random& random) {
    Blueprint b("laptop");
    const double w = random(0.3, 0.38), d = random(0.21, 0.26);
    const int base = b.foot(b.box("keyboard", 0, 0, 0, {w, d, 0.022}));
    b.join(base, b.box("screen", 0, -d / 2 + 0.008, 0.022, {w, 0.016, d}));
    return b;
}

// Each book or box is an object of its own; every one lies within the one below.
Stack stack(Random& random) {
    Stack all;
    double w = random(0.22, 0.3), d = random(0.16, 0.22);
    const int count = random.integer(2, 4);
    for (int k = 0; k < count; ++k) {
        all.push_back(lone_box("book", "book", {w, d, random(0.045, 0.09)}));
        all.back().stand_on(0, 1, "stack", 0);
        w *= random(0.75, 0.92);
        d *= random(0.75, 0.92);
    }
    return all;
}

double footprint_radius(const Blueprint& b) {
    const auto box = b.bounds();
    return std::hypot(std::max(-box[0][0], box[1][0]), std::max(-box[0][1], box[1][1]));
}

Stack any_item(Random& random) {
    constexpr std::array makes{cup,  bottle,  lying_bottle,    ball,    plain_carton,
                               vase, pyramid, plain_desk_lamp, monitor, laptop};
    const std::size_t which = random.index(makes.size() + 1);
    return which < makes.size() ? std::vector{makes[which](random)} : stack(random);
}

}  // namespace

Stack make_item(Random& random, double height, double radius) {
    for (int attempt = 0; attempt < 40; ++attempt) {
        auto item = any_item(random);
        if (stack_height(item) <= height && footprint_radius(item.front()) <= radius) return item;
    }
    return {};
}

}  // namespace topple::scenes
