// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "topple/input.h"
#include "topple/scene.h"

// From counts of falls to chances, and from these to rates.
namespace topple::safety {

// So many of as many trials at one strength of shaking ended in a fall.
struct Trials {
    double strength = 0;  // above 0, in any unit
    unsigned falls = 0, of = 0;
};

// P(fall | x) = Phi(ln(x / median) / dispersion)
struct Lognormal {
    double median = 0, dispersion = 0;
    double chance(double strength) const;
};
inline constexpr double least_dispersion = 0.05, most_dispersion = 1.5;

// The likeliest lognormal: the greatest sum of falls ln P + (of - falls) ln(1 - P), by Fisher's
// scoring on P = Phi(a + b ln x), in which that sum is concave, with 1 / b between the bounds
// above. None where fewer than half of the trials at the greatest strength are falls.
std::optional<Lognormal> fit_lognormal(std::span<const Trials> trials);

// Of falling in a shaking of this peak, g: the lognormal's, or without a dispersion that of the
// steps, straight between them over the peak's logarithm.
double chance_of_fall(const Fragility& fragility, double pga_g);

// Whether it falls in so many of the shakings of this peak, a tenth, that those below it count.
bool falls_below(const Fragility& fragility, double pga_g);

// How many falls a year: the integral of the chance of falling over the annual rates at which peaks
// come. Peaks beyond the curve's last count as that one; those below its first as none.
double falls_per_year(const HazardCurve& hazard, const Fragility& fragility);

// The first peak at which half falls, between the steps as above; NaN where none is.
double half_falls_g(const Fragility& fragility);

// The counts over peak acceleration, g, rising, and what follows from them: median and dispersion
// of the lognormal, or the median alone where they level off. There must be one.
Fragility fragility_of(std::span<const Trials> peaks);

}  // namespace topple::safety
