// SPDX-License-Identifier: MIT
#include "physics/alike.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace topple::physics {
namespace {

// Voxels, what stands beside them and what was not seen of them make boxes of equal things differ.
constexpr double alike_share = 0.15;

bool alike_sides(double a, double b) {
    return std::abs(a - b) <= alike_share * std::max(a, b);
}

bool are_alike(const FurnitureLooks& a, const FurnitureLooks& b) {
    return a.box_m[0] > 0 && alike_sides(a.height_m, b.height_m) &&
           alike_sides(a.box_m[0], b.box_m[0]) && alike_sides(a.box_m[1], b.box_m[1]);
}

}  // namespace

Alike alike_objects(std::span<const FurnitureLooks> looks) {
    Alike out(looks.size());
    for (std::size_t a = 0; a < looks.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
            if (!are_alike(looks[a], looks[b])) continue;
            out[a].push_back(static_cast<std::int32_t>(b));
            out[b].push_back(static_cast<std::int32_t>(a));
        }
    return out;
}

std::vector<double> probabilities_closed(std::span<const FurnitureLooks> looks,
                                         const Alike& alike) {
    const auto log_odds = [](double p) { return std::log(p / (1 - p)); };
    const auto told = [&](std::size_t o) {
        return log_odds(probability_closed(looks[o])) - log_odds(closed_share);
    };
    std::vector<double> out(looks.size(), 0);
    for (std::size_t o = 0; o < looks.size(); ++o) {
        if (looks[o].fill < least_furniture_fill) continue;
        double sum = log_odds(closed_share) + told(o);
        for (const std::int32_t other : alike[o]) {
            const auto at = static_cast<std::size_t>(other);
            if (looks[at].fill >= least_furniture_fill) sum += told(at);
        }
        out[o] = 1 / (1 + std::exp(-sum));
    }
    return out;
}

double error_among_alike_kg(std::span<const double> mass_kg, std::span<const std::int32_t> alike,
                            std::size_t object) {
    if (alike.empty() || !(mass_kg[object] > 0)) return 0;
    double squares = 0;
    for (const std::int32_t other : alike) {
        const double mass = mass_kg[static_cast<std::size_t>(other)];
        const double off = mass > 0 ? std::log(mass / mass_kg[object]) : 0;
        squares += off * off;
    }
    const double deviation = std::sqrt(squares / (2 * static_cast<double>(alike.size())));
    return mass_kg[object] * (1 - std::exp(-deviation));
}

}  // namespace topple::physics
