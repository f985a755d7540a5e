// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/furniture/profiles.h"
#include "lab/furniture/varied.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

Blueprint turned(const char* name, solids::Profile profile) {
    return lone_revolved(name, name, std::move(profile));
}

Blueprint glass_bottle(Random& random) {
    const double r = random(0.033, 0.05), neck = random(0.3, 0.45) * r;
    const double body = random(0.13, 0.19), shoulder = random(0.03, 0.07), top = random(0.04, 0.08);
    Side side = joined({{r, 0}, {r, body}}, quarter(r, body, neck - r, shoulder, false));
    side.push_back({neck, body + shoulder + top});
    return turned("glass bottle", solid_within(side));
}

Blueprint bowl(Random& random) {
    const double foot = random(0.03, 0.05), r = random(0.08, 0.15);
    const double h = random(0.05, 0.1);
    return turned("bowl", vessel_within(joined({{foot, 0}}, quarter(foot, 0, r - foot, h, true)),
                                        random(0.006, 0.009), 0.01));
}

Blueprint mug(Random& random) {
    const double r = random(0.036, 0.05), h = random(0.08, 0.12);
    return turned("mug", vessel_within({{0.9 * r, 0}, {r, h}}, 0.006, 0.008));
}

Blueprint plate(Random& random) {
    const double r = random(0.1, 0.15), h = random(0.018, 0.03);
    return turned("plate", vessel_within({{0.6 * r, 0}, {r, h}}, 0.02, 0.008));
}

Blueprint amphora(Random& random) {
    const double r = random(0.05, 0.08), h = random(0.2, 0.34);
    return turned(
        "amphora",
        vessel_within(
            smooth_side({0.6 * r, r, random(0.9, 1.2) * r, random(0.35, 0.6) * r, 0.7 * r}, h),
            0.008, 0.015));
}

// Any shape that a lathe can make.
Blueprint figurine(Random& random) {
    std::vector<double> radii{random(0.035, 0.055)};
    for (int k = random.integer(3, 5); k > 0; --k) radii.push_back(random(0.015, 0.055));
    return turned("figurine", solid_within(smooth_side(radii, random(0.14, 0.3))));
}

Blueprint wine_glass(Random& random) {
    Blueprint b("goblet");
    const double r = random(0.035, 0.05), stem = random(0.06, 0.1);
    const int foot =
        b.foot(b.revolved("foot", 0, 0, 0, solid_within({{r, 0}, {r, 0.006}, {0.3 * r, 0.015}})));
    const int bar = b.join(foot, b.cylinder("stem", 0, 0, 0.015, 0.014, stem));
    b.join(bar, b.revolved("bowl", 0, 0, 0.015 + stem,
                           vessel_within(joined({{0.3 * r, 0}}, quarter(0.3 * r, 0, 0.8 * r,
                                                                        random(0.06, 0.1), true)),
                                         0.005, 0.01)));
    return b;
}

// Its screen leans back by more than a right angle to the keys.
Blueprint open_laptop(Random& random) {
    Blueprint b("open laptop");
    const double w = random(0.3, 0.38), d = random(0.21, 0.26), t = 0.02;
    const int keys = b.foot(b.box("keyboard", 0, 0, 0, {w, d, t}));
    b.join(keys, b.leaning("screen", 0, -d / 2 + 0.012, t, {w, 0.012, d}, random(0.1, 0.6)));
    return b;
}

// A leaning panel and the prop behind it, whose upper edge touches its back.
Blueprint photo_frame(Random& random) {
    Blueprint b("photo frame");
    const double w = random(0.14, 0.26), h = random(0.16, 0.28), t = 0.018;
    const double lean = random(0.15, 0.3), prop = random(0.3, 0.5);
    const int panel = b.leaning("panel", 0, 0, 0, {w, t, h}, lean);
    const double length = 0.55 * h;
    const double y = -length * (std::sin(prop) + std::cos(prop) * std::tan(lean));
    const int strut = b.join(panel, b.leaning("prop", 0, y, 0, {0.05, 0.012, length}, -prop));
    b.feet = {panel, strut};
    return b;
}

Blueprint arm_lamp(Random& random) {
    Blueprint b("arm lamp");
    const double r = 0.1, t = 0.04;
    const int base = b.foot(b.revolved(
        "base", 0, 0, 0, solid_within(joined({{r, 0}}, quarter(r, 0, -0.06, t, false)))));
    b.arm(base, {0, 0, t},
          {{random(0.16, 0.26), random(-0.5, -0.1)}, {random(0.12, 0.22), random(0.4, 0.9)}}, 0.022,
          random(0.1, 0.13));
    return b;
}

// The panel's back leans against the upper front edge of the neck.
Blueprint tilted_monitor(Random& random) {
    Blueprint b("tilted monitor");
    const double w = random(0.45, 0.62), h = 0.6 * w, lean = random(0.08, 0.3);
    const double low = random(0.06, 0.12), top = low + 0.55 * h, neck = 0.04;
    const int base = b.foot(b.rounded("base", 0, 0, 0, {random(0.2, 0.28), 0.19, 0.024}, 0.008));
    const int stem = b.join(base, b.box("neck", 0, -0.04, 0.024, {0.08, neck, top - 0.024}));
    const double edge = -0.04 + neck / 2;
    b.join(stem,
           b.leaning("panel", 0, edge + (top - low) * std::tan(lean), low, {w, 0.035, h}, lean));
    return b;
}

Blueprint rounded_device(Random& random) {
    Blueprint b(random.chance(0.5) ? "toaster" : "speaker");
    const Vec3 size{random(0.12, 0.3), random(0.12, 0.2), random(0.14, 0.26)};
    b.foot(b.rounded("body", 0, 0, 0, size, random(0.015, 0.05)));
    return b;
}

Blueprint toy_truck(Random& random) {
    Blueprint b("toy truck");
    const double w = random(0.08, 0.12), l = random(0.2, 0.3), wheel = 0.06;
    const int chassis = b.box("chassis", 0, 0, 0.02, {w, l, 0.045});
    b.join(chassis, b.rounded("cab", 0, 0.3 * l, 0.065, {w - 0.01, 0.35 * l, 0.08}, 0.015));
    for (const auto [sx, sy] : corners) {
        b.foot(b.join(chassis,
                      b.lying("wheel", sx * (w / 2 + 0.0125), sy * 0.3 * l, 0, 0.025, wheel)));
    }
    return b;
}

// Upright books side by side with hardly any air between them.
Group book_row(Random& random) {
    Group row;
    const int count = random.integer(3, 7);
    double x = 0;
    for (int k = 0; k < count; ++k) {
        const double t = random(0.02, 0.05), d = random(0.13, 0.19);
        Blueprint book = lone_box("upright book", "book", {t, d, random(0.18, 0.27)});
        row.push_back({std::move(book), {x + t / 2, random(-0.02, 0.02), 0, 0}});
        x += t + random(0.001, 0.004);
    }
    for (Member& m : row) m.pose.x -= x / 2;
    return row;
}

Group any_varied_item(Random& random) {
    constexpr auto plant = [](Random& r) { return make_leafy_plant(r, 0.5); };
    constexpr std::array<BlueprintMake, 16> single{
        glass_bottle,   glass_bottle,   bowl,       bowl,        mug,         plate,
        amphora,        figurine,       wine_glass, open_laptop, photo_frame, arm_lamp,
        tilted_monitor, rounded_device, toy_truck,  plant};
    const std::size_t which = random.index(single.size() + 4);
    if (which < single.size()) return {{single[which](random), {}}};
    switch (which - single.size()) {
        case 0:
            return book_row(random);
        case 1:
            return make_pile(random, {0.26, 0.19, 0.05}, random.integer(3, 6));  // books
        case 2:
            return make_pile(random, {0.2, 0.17, 0.12}, random.integer(2, 3));  // boxes
    }
    Group group;
    for (Blueprint& b : make_item(random, 1, 1)) {
        const int on = static_cast<int>(group.size()) - 1;
        group.push_back({std::move(b), {0, 0, height(group), random(-0.08, 0.08)}, on});
    }
    return group;
}

}  // namespace

double height(const Group& group) {
    double top = 0;
    for (const Member& m : group) top = std::max(top, m.pose.z + m.blueprint.height());
    return top;
}

std::array<double, 2> reach(const Group& group, double yaw) {
    std::array<double, 2> most{};
    for (const Member& m : group) {
        if (m.on >= 0) continue;
        for (const int foot : m.blueprint.feet) {
            const Part& part = m.blueprint.parts[foot];
            const auto box = moved({0, 0, 0, yaw}, moved(m.pose, part)).bounds();
            for (std::size_t a = 0; a < 2; ++a)
                most[a] = std::max({most[a], -box[0][a], box[1][a]});
        }
    }
    return most;
}

Group make_varied_item(Random& random, double most_height, double radius) {
    for (int attempt = 0; attempt < 40; ++attempt) {
        Group group = any_varied_item(random);
        const auto far = reach(group, 0);
        if (!group.empty() && height(group) <= most_height && std::hypot(far[0], far[1]) <= radius)
            return group;
    }
    return {};
}

Group make_pillow(Random& random) {
    const double t = random(0.1, 0.16);
    const Vec3 size{random(0.4, 0.6), random(0.3, 0.38), t};
    return {{lone_rounded("pillow", "pillow", size, 0.48 * t), {}}};
}

Group make_pile(Random& random, const Vec3& lowest_size, int count) {
    Group pile;
    Vec3 size = lowest_size;
    double z = 0;
    for (int k = 0; k < count; ++k) {
        const Vec3 one{size[0] * random(0.8, 1.1), size[1] * random(0.8, 1.1),
                       size[2] * random(0.6, 1.3)};
        // All that is above a box has its center within a tenth of the sizes from the pile's axis.
        const Pose pose{k == 0 ? 0 : random(-0.1, 0.1) * size[0],
                        k == 0 ? 0 : random(-0.1, 0.1) * size[1], z,
                        k == 0 ? 0 : random(-0.6, 0.6)};
        pile.push_back({lone_box("piled box", "box", one), pose, k - 1});
        z += one[2];
        for (std::size_t a = 0; a < 2; ++a) size[a] *= random(0.85, 1.0);
    }
    return pile;
}

}  // namespace topple::scenes
