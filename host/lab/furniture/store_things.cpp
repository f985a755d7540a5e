// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/furniture/profiles.h"
#include "lab/furniture/things.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

Blueprint crate(Random& random) {
    Blueprint b("crate");
    const double w = random(0.3, 0.6), d = random(0.25, 0.4), h = random(0.16, 0.34), t = 0.014;
    b.foot(b.box("floor", 0, 0, 0, {w, d, t}));
    const int slats = random.chance(0.5) ? 1 : random.integer(2, 3);
    for (int k = 0; k < slats; ++k) {
        const double high = (h - t) / slats, z = t + k * high;
        const double tall = slats == 1 ? high : 0.75 * high;
        for (const double s : {-1.0, 1.0}) {
            b.box("side", s * (w - t) / 2, 0, z, {t, d, tall});
            b.box("side", 0, s * (d - t) / 2, z, {w - 2 * t, t, tall});
        }
    }
    if (slats > 1) {
        for (const auto [sx, sy] : corners)
            b.box("post", sx * (w / 2 - 0.03), sy * (d / 2 - 0.03), t, {0.03, 0.03, h - t});
    }
    return b;
}

Blueprint canister(Random& random) {
    Blueprint b("canister");
    const double w = random(0.15, 0.3), h = random(0.22, 0.4);
    b.foot(b.rounded("body", 0, 0, 0, {w, 0.7 * w, h}, 0.03));
    b.cylinder("cap", 0.3 * w, 0, h, 0.05, 0.03);
    b.box("handle", -0.1 * w, 0, h + 0.03, {0.5 * w, 0.03, 0.02});
    for (const double s : {-0.33, 0.13}) b.box("handle", s * w, 0, h - 0.01, {0.02, 0.03, 0.05});
    return b;
}

}  // namespace

Blueprint make_carton(Random& random, double most) {
    Blueprint b("carton");
    const Vec3 size{random(0.4, 1) * most, random(0.4, 1) * most, random(0.3, 0.9) * most};
    const bool open = random.chance(0.15) && size[2] > 0.15;
    if (!open) {
        b.foot(b.box("box", 0, 0, 0, size));
        if (random.chance(0.5))
            b.box("tape", 0, 0, size[2] - 0.001, {0.05, size[1] + 0.002, 0.002});
        return b;
    }
    constexpr double t = 0.006;
    b.foot(b.box("floor", 0, 0, 0, {size[0], size[1], t}));
    for (const double s : {-1.0, 1.0}) {
        b.box("side", s * (size[0] - t) / 2, 0, t, {t, size[1], size[2] - t});
        b.box("side", 0, s * (size[1] - t) / 2, t, {size[0] - 2 * t, t, size[2] - t});
        b.leaning("flap", 0, s * size[1] / 2, size[2] - 0.002, {0.9 * size[0], t, 0.3 * size[1]},
                  -s * random(0.4, 1.4));
    }
    return b;
}

Blueprint make_rack(Random& random, double most_height) {
    Blueprint b("rack");
    const int bays = random.integer(1, 3);
    const double bay = random(0.8, 2.4), d = random(0.4, 1.0);
    const double h = std::min(most_height, random(1.6, 3.2)), post = random(0.03, 0.09);
    const double w = bays * bay + post;
    for (int k = 0; k <= bays; ++k) {
        const double x = -w / 2 + post / 2 + k * bay;
        for (const double s : {-1.0, 1.0})
            b.foot(b.box("upright", x, s * (d - post) / 2, 0, {post, post, h}));
        for (double z = 0.25; z < h - 0.4; z += 0.7)
            b.bar("brace", {x, -(d - post) / 2, z}, {x, (d - post) / 2, z + 0.35}, 0.6 * post);
    }
    const int levels = std::max(2, static_cast<int>(h / random(0.45, 1.1)));
    const bool solid = random.chance(0.7);
    for (int level = 0; level < levels; ++level) {
        const double z = 0.08 + level * (h - 0.3) / std::max(1, levels - 1), t = random(0.02, 0.05);
        const double clear = level + 1 < levels ? (h - 0.3) / (levels - 1) - t - 0.1 : 0.6;
        for (const double s : {-1.0, 1.0})
            b.box("beam", 0, s * (d - 0.7 * post) / 2, z - 0.06, {w - post, 0.6 * post, 0.06});
        for (int k = 0; k < bays; ++k) {
            const double x = -w / 2 + post / 2 + (k + 0.5) * bay;
            if (solid) {
                const int deck = b.box("deck", x, 0, z, {bay - post - 0.004, d, t});
                b.surfaces.push_back(
                    {deck, x, 0, bay / 2 - post - 0.01, d / 2 - 0.01, clear, "rack"});
            } else {
                const int planks = std::max(2, static_cast<int>(d / 0.16));
                for (int p = 0; p < planks; ++p) {
                    const int plank = b.box("deck", x, (p + 0.5 - planks / 2.0) * d / planks, z,
                                            {bay - post, 0.7 * d / planks, t});
                    if (p == planks / 2)
                        b.surfaces.push_back(
                            {plank, x, 0, bay / 2 - post - 0.01, d / 2 - 0.01, clear, "rack"});
                }
            }
        }
    }
    return b;
}

Blueprint make_pallet(Random& random) {
    Blueprint b("pallet");
    const double w = 1.2, d = random.chance(0.6) ? 0.8 : 1.0;
    for (const double s : {-1.0, 0.0, 1.0}) {
        b.foot(b.box("runner", 0, s * (d / 2 - 0.05), 0, {w, 0.1, 0.022}));
        for (const double x : {-1.0, 0.0, 1.0})
            b.box("block", x * (w / 2 - 0.07), s * (d / 2 - 0.05), 0.022, {0.14, 0.1, 0.1});
    }
    int middle = 0;
    for (int k = 0; k < 5; ++k) {
        const int plank = b.box("plank", 0, (k - 2) * (d - 0.13) / 4, 0.122, {w, 0.13, 0.022});
        if (k == 2) middle = plank;
    }
    b.surfaces.push_back({middle, 0, 0, w / 2, d / 2, 2.0, "pallet"});
    return b;
}

Blueprint make_trolley(Random& random) {
    Blueprint b("trolley");
    const double w = random(0.6, 1.1), d = random(0.45, 0.65), z = 0.14;
    for (const auto [sx, sy] : corners)
        b.foot(b.lying("wheel", sx * (w / 2 - 0.1), sy * (d / 2 - 0.08), 0, 0.03, z, pi / 2));
    const int deck = b.box("deck", 0, 0, z - 0.005, {w, d, 0.03});
    const double h = random(0.8, 1.0);
    for (const double s : {-1.0, 1.0})
        b.bar("rail", {-w / 2 + 0.02, s * (d / 2 - 0.03), z},
              {-w / 2 - 0.04, s * (d / 2 - 0.03), h}, 0.03);
    b.lying("rail", -w / 2 - 0.04, 0, h - 0.015, d, 0.03, pi / 2);
    b.surfaces.push_back({deck, 0.03, 0, w / 2 - 0.08, d / 2 - 0.03, 1.2, "trolley"});
    if (random.chance(0.4)) {
        const int upper = b.box("deck", 0, 0, 0.6, {w - 0.06, d, 0.02});
        for (const double s : {-1.0, 1.0})
            b.box("rail", w / 2 - 0.05, s * (d / 2 - 0.03), z, {0.03, 0.03, 0.48});
        b.surfaces[0].clearance = 0.42;
        b.stand_on(upper, 0.6, "trolley", 0.05);
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

Blueprint make_bucket(Random& random) {
    Blueprint b("bucket");
    const double r = random(0.11, 0.16), h = random(0.22, 0.34);
    b.foot(b.revolved("body", 0, 0, 0, vessel_within({{0.75 * r, 0}, {r, h}}, 0.005, 0.006)));
    for (int k = 0; k < 6; ++k) {  // the handle, fallen to one side or upright
        const double a = pi * k / 6, c = pi * (k + 1) / 6;
        b.bar("handle", {r * std::cos(a), 0, h + r * std::sin(a) - 0.01},
              {r * std::cos(c), 0, h + r * std::sin(c) - 0.01}, 0.008);
    }
    return b;
}

Blueprint make_drum(Random& random) {
    Blueprint b("drum");
    const double r = random(0.2, 0.3), h = random(0.55, 0.9);
    b.foot(b.cylinder("body", 0, 0, 0, 2 * r, h));
    for (const double z : {0.0, 0.33, 0.66})
        b.cylinder("hoop", 0, 0, z * h + 0.01, 2 * r + 0.02, 0.025);
    b.cylinder("cap", 0.6 * r, 0, h, 0.06, 0.02);
    b.surfaces.push_back({0, -0.2 * r, 0, 0.4 * r, 0.5 * r, 0.5, "drum"});
    return b;
}

Blueprint make_step_ladder(Random& random) {
    Blueprint b("ladder");
    const double h = random(0.6, 1.9), w = 0.42, lean = 0.22;
    std::vector<int> sides;
    for (const double s : {-1.0, 1.0}) {
        const double foot = 0.02 + h * std::tan(lean);
        sides.push_back(
            b.leaning("stringer", s * w / 2, foot, 0, {0.03, 0.06, h / std::cos(lean)}, lean));
        b.foot(sides.back());
        b.foot(b.leaning("strut", s * w / 2, -0.02 - h * std::tan(lean), 0,
                         {0.025, 0.025, h / std::cos(lean)}, -lean));
    }
    const int steps = std::max(2, static_cast<int>(h / 0.25));
    for (int k = 1; k <= steps; ++k) {
        const double z = k * h / (steps + 0.5);
        b.box("step", 0, (h - z) * std::tan(lean), z, {w, 0.1, 0.025});
    }
    b.box("platform", 0, 0, h - 0.02, {w, 0.22, 0.03});
    return b;
}

Blueprint make_gondola(Random& random) {
    Blueprint b("shelf");
    const double w = random(0.9, 2.2), d = random(0.5, 0.9), h = random(1.1, 1.7);
    b.foot(b.box("base", 0, 0, 0, {w, d, 0.12}));
    b.box("wall", 0, 0, 0.12, {w, 0.03, h - 0.12});
    for (const double s : {-1.0, 1.0})
        b.box("end", s * (w / 2 - 0.01), 0, 0.12, {0.02, 0.5 * d, h - 0.12});
    const int levels = random.integer(2, 4);
    for (const double side : {-1.0, 1.0}) {
        for (int k = 0; k < levels; ++k) {
            const double deep = (d / 2 - 0.03) * (k == 0 ? 1 : 0.8);
            const double z = k == 0 ? 0.12 : 0.12 + k * (h - 0.12) / levels;
            const double y = side * (0.015 + deep / 2);
            const int board = k == 0 ? 0 : b.box("board", 0, y, z - 0.02, {w - 0.04, deep, 0.02});
            b.surfaces.push_back(
                {board, 0, y, w / 2 - 0.04, deep / 2 - 0.01, (h - 0.12) / levels - 0.03, "shelf"});
        }
    }
    return b;
}

Stack make_store_item(Random& random, double clearance) {
    constexpr std::array<BlueprintMake, 3> makes{crate, canister, make_bucket};
    const auto which = static_cast<std::size_t>(random.integer(0, 6));
    const Blueprint one =
        which < makes.size() ? makes[which](random) : make_carton(random, random(0.2, 0.7));
    int count = which < makes.size() ? 1 : random.integer(1, 3);
    if (one.parts.size() >= 3) count = 1;  // on an open carton stands nothing
    Stack stack;
    while (count-- > 0 && stack_height(stack) + one.height() < clearance) stack.push_back(one);
    return stack;
}

Stack make_shop_item(Random& random, double clearance) {
    if (random.chance(0.55)) {
        const double h = std::min(clearance - 0.01, random(0.12, 0.35));
        if (h > 0.06) return {make_row(random, random(0.2, 1.2), h, random(0.1, 0.24))};
    }
    if (random.chance(0.3)) return make_desk_item(random, clearance);
    if (random.chance(0.5)) {
        Blueprint b = make_carton(random, 0.25);
        if (b.height() < clearance) return {b};
    }
    return make_turned_item(random, clearance);
}

}  // namespace topple::scenes
