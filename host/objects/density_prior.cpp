// SPDX-License-Identifier: MIT
#include "objects/density_prior.h"

#include <algorithm>
#include <cmath>

#include "core/object_name.h"

namespace topple {
namespace {

// How far edges and fill of things of one kind are apart, as standard deviations of logarithms.
constexpr double size_spread = 0.3, fill_spread = 0.5;
// Things of no kind in the table: as many as a kind that is two deviations away.
const double other_weight = std::exp(-2.0);
constexpr double other_kg_m3 = 450, other_spread = 0.9;

double square(double x) {
    return x * x;
}

}  // namespace

const ThingKind* named_kind(const Materials& materials, std::string_view name) {
    const ThingKind* found = nullptr;
    for (const ThingKind& kind : materials)
        if (name_has(name, kind.name) && (!found || kind.name.size() > found->name.size()))
            found = &kind;
    return found;
}

double DensityPrior::error_share() const {
    const auto below = [&](double share) {  // the probability
        return share > 0 ? std::erfc(-std::log(share) / (spread * std::sqrt(2.0))) / 2 : 0.0;
    };
    const double one_deviation = std::erf(1 / std::sqrt(2.0));
    double low = 0, high = std::exp(spread);
    for (int halving = 0; halving < 50; ++halving) {
        const double middle = (low + high) / 2;
        (below(1 + middle) - below(1 - middle) < one_deviation ? low : high) = middle;
    }
    return spread > 0 ? low : 0;
}

DensityPrior density_prior(const Materials& materials, std::string_view name, Vec3 size_m,
                           double fill) {
    if (const ThingKind* kind = named_kind(materials, name))
        return {kind->density_kg_m3, kind->spread};
    std::ranges::sort(size_m);
    const bool measured = size_m[0] > 0 && fill > 0;
    // Moments of the logarithm of a mixture.
    double weights = other_weight, sum = other_weight * std::log(other_kg_m3);
    double squares = other_weight * (square(other_spread) + square(std::log(other_kg_m3)));
    for (const ThingKind& kind : materials) {
        if (!measured) break;
        double unlike = square(std::log(fill / kind.fill) / fill_spread);
        for (std::size_t a = 0; a < 3; ++a)
            unlike += square(std::log(size_m[a] / kind.size_m[a]) / size_spread);
        const double weight = std::exp(-unlike / 2), log_density = std::log(kind.density_kg_m3);
        weights += weight;
        sum += weight * log_density;
        squares += weight * (square(kind.spread) + square(log_density));
    }
    const double mean = sum / weights;
    return {std::exp(mean), std::sqrt(std::max(0.0, squares / weights - square(mean)))};
}

}  // namespace topple
