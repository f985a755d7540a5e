// SPDX-License-Identifier: MIT
#include "lab/furniture/profiles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace topple::scenes {
namespace {

constexpr int steps = 6;  // of each curve

}  // namespace

solids::Profile solid_within(const Side& side) {
    solids::Profile all{{0, side.front()[1]}};
    all.insert(all.end(), side.begin(), side.end());
    all.push_back({0, side.back()[1]});
    return all;
}

solids::Profile vessel_within(const Side& side, double wall, double floor) {
    solids::Profile all{{0, side.front()[1]}};
    all.insert(all.end(), side.begin(), side.end());
    // Back down on the inside, to where the floor's upper face cuts it.
    const double low = side.front()[1] + floor;
    for (std::size_t n = side.size(); n-- > 0;) {
        const auto [r, z] = side[n];
        if (z > low) {
            all.push_back({r - wall, z});
            continue;
        }
        const auto [above_r, above_z] = side[n + 1];
        const double share = (low - z) / (above_z - z);
        all.push_back({r + share * (above_r - r) - wall, low});
        break;
    }
    all.push_back({0, low});
    return all;
}

Side smooth_side(const std::vector<double>& radii, double height) {
    const auto last = static_cast<int>(radii.size()) - 1;
    const auto radius = [&](int n) { return radii[std::clamp(n, 0, last)]; };
    Side side;
    for (int n = 0; n < last; ++n) {
        const double a = radius(n - 1), b = radius(n), c = radius(n + 1), d = radius(n + 2);
        for (int k = 0; k < steps; ++k) {
            const double t = static_cast<double>(k) / steps;
            const double r =
                b +
                t / 2 * ((c - a) + t * ((2 * a - 5 * b + 4 * c - d) + t * (3 * (b - c) + d - a)));
            side.push_back({std::max(r, 0.004), height * (n + t) / last});
        }
    }
    side.push_back({radii.back(), height});
    return side;
}

Side quarter(double r, double z, double dr, double dz, bool level) {
    Side side;
    for (int k = 1; k <= steps; ++k) {
        const double angle = std::numbers::pi / 2 * k / steps;
        const double s = std::sin(angle), c = 1 - std::cos(angle);
        side.push_back({r + dr * (level ? s : c), z + dz * (level ? c : s)});
    }
    return side;
}

Side joined(Side first, const Side& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

}  // namespace topple::scenes
