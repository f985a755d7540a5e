// SPDX-License-Identifier: MIT
#include "safety/earthquake/fragility.h"

#include <algorithm>
#include <cmath>

#include "core/normal.h"

namespace topple::safety {
namespace {

// Counts that end below this level off: a lognormal, which goes on to 1, does not describe them.
constexpr double least_at_strongest = 0.9;

// What falls in so many of the weakest shakings falls in weaker ones, too, but nobody knows how
// weak.
constexpr double most_at_weakest = 0.5;

// Of the log-likelihood in (a, b): its slopes, and Fisher's information.
struct Score {
    double a = 0, b = 0, aa = 0, ab = 0, bb = 0;
};
Score score(std::span<const Trials> trials, double a, double b) {
    Score s;
    for (const Trials& t : trials) {
        const double x = std::log(t.strength), z = std::clamp(a + b * x, -8.0, 8.0);
        const double p = normal_cdf(z), d = normal_density(z), spread = p * normal_cdf(-z);
        const double slope = d / spread * (t.falls - t.of * p), weight = t.of * d * d / spread;
        s.a += slope;
        s.b += slope * x;
        s.aa += weight;
        s.ab += weight * x;
        s.bb += weight * x * x;
    }
    return s;
}

double counted_chance(const Fragility& f, double pga_g) {
    if (f.counted.empty()) return 0;
    const Fragility::Step& weakest = f.counted.front();
    if (pga_g < weakest.pga_g) return weakest.chance >= most_at_weakest ? weakest.chance : 0;
    for (std::size_t n = 0; n + 1 < f.counted.size(); ++n) {
        const auto &low = f.counted[n], &high = f.counted[n + 1];
        if (pga_g >= high.pga_g) continue;
        const double way = std::log(pga_g / low.pga_g) / std::log(high.pga_g / low.pga_g);
        return low.chance + way * (high.chance - low.chance);
    }
    return f.counted.back().chance;
}

}  // namespace

double Lognormal::chance(double strength) const {
    return strength > 0 ? normal_cdf(std::log(strength / median) / dispersion) : 0;
}

std::optional<Lognormal> fit_lognormal(std::span<const Trials> trials) {
    double strongest = 0;
    for (const Trials& t : trials) strongest = std::max(strongest, t.strength);
    double falls = 0, of = 0, weighted = 0, all = 0;
    for (const Trials& t : trials) {
        // Near the strongest: peaks of velocity differ between records of one acceleration.
        if (t.strength > 0.999 * strongest) {
            falls += t.falls;
            of += t.of;
        }
        weighted += t.falls * std::log(t.strength);
        all += t.falls;
    }
    if (of == 0 || 2 * falls < of) return std::nullopt;
    double b = 2, a = -b * weighted / all;
    for (int round = 0; round < 200; ++round) {
        const Score s = score(trials, a, b);
        const double det = s.aa * s.bb - s.ab * s.ab;
        if (!(s.aa > 0)) break;
        double da = s.a / s.aa, db = 0;
        if (det > 1e-12 * s.aa * s.bb) {
            da = (s.bb * s.a - s.ab * s.b) / det;
            db = (s.aa * s.b - s.ab * s.a) / det;
        }
        const double next =
            std::clamp(b + std::clamp(db, -1.0, 1.0), 1 / most_dispersion, 1 / least_dispersion);
        if (next != b + db) {  // at a bound, or a step cut short: the best a for that b
            db = next - b;
            da = (s.a - s.ab * db) / s.aa;
        }
        da = std::clamp(da, -2.0, 2.0);
        a += da;
        b = next;
        if (std::fabs(da) + std::fabs(db) < 1e-10) break;
    }
    return Lognormal{std::exp(-a / b), 1 / b};
}

double half_falls_g(const Fragility& fragility) {
    const auto& counted = fragility.counted;
    for (std::size_t n = 0; n < counted.size(); ++n) {
        if (counted[n].chance < 0.5) continue;
        if (n == 0) return counted[n].pga_g;
        const auto &low = counted[n - 1], &high = counted[n];
        const double way = (0.5 - low.chance) / (high.chance - low.chance);
        return low.pga_g * std::pow(high.pga_g / low.pga_g, way);
    }
    return Fragility::none;
}

Fragility fragility_of(std::span<const Trials> peaks) {
    Fragility f;
    for (const Trials& t : peaks)
        f.counted.push_back({t.strength, static_cast<double>(t.falls) / t.of});
    if (f.counted.back().chance < least_at_strongest ||
        f.counted.front().chance >= most_at_weakest) {
        f.pga_g = half_falls_g(f);
    } else if (const auto fitted = fit_lognormal(peaks)) {
        f.pga_g = fitted->median;
        f.pga_dispersion = fitted->dispersion;
    }
    return f;
}

double chance_of_fall(const Fragility& fragility, double pga_g) {
    return std::isfinite(fragility.pga_dispersion)
               ? Lognormal{fragility.pga_g, fragility.pga_dispersion}.chance(pga_g)
               : counted_chance(fragility, pga_g);
}

bool falls_below(const Fragility& fragility, double pga_g) {
    return chance_of_fall(fragility, pga_g) >= 0.1;
}

double falls_per_year(const HazardCurve& hazard, const Fragility& fragility) {
    const auto chance = [&](double pga_g) { return chance_of_fall(fragility, pga_g); };
    constexpr int parts = 64;
    double rate = 0;
    for (std::size_t n = 0; n + 1 < hazard.pga_g.size(); ++n) {
        const auto at = [](double from, double to, double way) {
            return std::exp(std::log(from) + way * (std::log(to) - std::log(from)));
        };
        for (int k = 0; k < parts; ++k) {
            const double low = static_cast<double>(k) / parts, high = (k + 1.0) / parts;
            const auto rate_at = [&](double way) {
                return at(hazard.per_year[n], hazard.per_year[n + 1], way);
            };
            rate += chance(at(hazard.pga_g[n], hazard.pga_g[n + 1], (low + high) / 2)) *
                    (rate_at(low) - rate_at(high));
        }
    }
    return rate + chance(hazard.pga_g.back()) * hazard.per_year.back();
}

}  // namespace topple::safety
