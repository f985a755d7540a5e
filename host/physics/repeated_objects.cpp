// SPDX-License-Identifier: MIT
#include "physics/repeated_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace topple::physics {
namespace {

// Voxels, what stands beside them and what was not seen of them make boxes of equal things differ.
constexpr double alike_share = 0.15;
// The log-odds of being closed that the share of a box's columns that a wall is seen behind is off
// by.
constexpr double odds_error = 0.3;
constexpr double least_share = 0.005;  // of ways to fall that count

bool alike_sides(double a, double b) {
    return std::abs(a - b) <= alike_share * std::max(a, b);
}

bool are_alike(const FurnitureLooks& a, const FurnitureLooks& b) {
    return a.box_m[0] > 0 && alike_sides(a.height_m, b.height_m) &&
           alike_sides(a.box_m[0], b.box_m[0]) && alike_sides(a.box_m[1], b.box_m[1]);
}

}  // namespace

Repeated find_repeated(std::span<const FurnitureLooks> looks) {
    Repeated out(looks.size());
    for (std::size_t a = 0; a < looks.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
            if (!are_alike(looks[a], looks[b])) continue;
            out[a].push_back(static_cast<std::int32_t>(b));
            out[b].push_back(static_cast<std::int32_t>(a));
        }
    return out;
}

std::vector<ClosedOdds> closed_odds(std::span<const FurnitureLooks> looks, const Repeated& alike) {
    const auto chance = [](double log_odds) { return 1 / (1 + std::exp(-log_odds)); };
    const double before = std::log(closed_share / (1 - closed_share));
    const auto tells = [&](std::size_t o) { return looks[o].fill >= least_furniture_fill; };
    std::vector<ClosedOdds> out(looks.size());
    for (std::size_t o = 0; o < looks.size(); ++o) {
        if (!tells(o)) continue;
        const auto odds = [&](const auto& backing) {
            double sum = log_odds_closed(looks[o], backing(looks[o]));
            for (const std::int32_t other : alike[o]) {
                const auto at = static_cast<std::size_t>(other);
                if (tells(at)) sum += log_odds_closed(looks[at], backing(looks[at])) - before;
            }
            return sum;
        };
        const double usual = odds([](const FurnitureLooks& l) { return l.backing; });
        const double less = odds([](const FurnitureLooks&l) { return l.backing_range[0]; }),
                     more = odds([](const FurnitureLooks&l) { return l.backing_range[1]; });
        const double closed =
            (chance(less / odds_error) + chance(usual / odds_error) + chance(more / odds_error)) /
            3;
        out[o] = {chance(usual), closed < least_share ? 0 : closed > 1 - least_share ? 1 : closed};
    }
    return out;
}

double error_among_alike_kg(std::span<const double> mass_kg, std::span<const std::int32_t> alike,
                            std::size_t object) {
    if (alike.empty() || !(mass_kg[object] > 0)) return 0;
    double squares = 0;
    for (const std::int32_t other : alike) {
        const double mass = mass_kg[other];
        const double off = mass > 0 ? std::log(mass / mass_kg[object]) : 0;
        squares += off * off;
    }
    const double deviation = std::sqrt(squares / (2 * static_cast<double>(alike.size())));
    return mass_kg[object] * (1 - std::exp(-deviation));
}

}  // namespace topple::physics
