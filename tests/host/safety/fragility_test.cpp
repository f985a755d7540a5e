// SPDX-License-Identifier: MIT
#include "safety/earthquake/fragility.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "device/devices.h"
#include "room.h"
#include "safety/fields.h"

namespace topple::safety {
namespace {

std::vector<Trials> trials_of(const Lognormal& truth, unsigned of, std::uint64_t seed) {
    Random random(seed);
    std::vector<Trials> out;
    for (double x = 0.05; x < 4; x *= 1.4) {
        Trials t{x, 0, of};
        for (unsigned n = 0; n < of; ++n) t.falls += random.uniform() < truth.chance(x);
        out.push_back(t);
    }
    return out;
}

double log_likelihood(std::span<const Trials> trials, const Lognormal& l) {
    double sum = 0;
    for (const Trials& t : trials) {
        const double p = std::clamp(l.chance(t.strength), 1e-12, 1 - 1e-12);
        sum += t.falls * std::log(p) + (t.of - t.falls) * std::log(1 - p);
    }
    return sum;
}

TEST(Fragility, FindsTheLognormalThatTrialsCameFrom) {
    for (const Lognormal truth : {Lognormal{0.3, 0.4}, Lognormal{1.0, 0.6}, Lognormal{0.1, 0.25}}) {
        const auto trials = trials_of(truth, 4000, 3);
        const auto found = fit_lognormal(trials);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->median / truth.median, 1, 0.02);
        EXPECT_NEAR(found->dispersion / truth.dispersion, 1, 0.04);
    }
}

// The likeliest of a grid around it, and of its bounds.
TEST(Fragility, NoOtherLognormalIsLikelier) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        const Lognormal truth{random.uniform(0.1, 1.0), random.uniform(0.02, 1.2)};
        const auto trials = trials_of(truth, 16, seed);
        const auto found = fit_lognormal(trials);
        if (!found) continue;
        const double best = log_likelihood(trials, *found);
        for (const double m : {0.97, 1.0, 1.03}) {
            for (const double d : {0.97, 1.0, 1.03}) {
                const Lognormal other{
                    found->median * m,
                    std::clamp(found->dispersion * d, least_dispersion, most_dispersion)};
                EXPECT_LE(log_likelihood(trials, other), best + 1e-6) << seed;
            }
        }
    }
}

TEST(Fragility, OfStepsIsSteepAndOfFewFallsNone) {
    std::vector<Trials> steps{{0.1, 0, 16}, {0.2, 0, 16}, {0.4, 16, 16}, {0.8, 16, 16}};
    const auto found = fit_lognormal(steps);
    ASSERT_TRUE(found);
    EXPECT_GT(found->median, 0.2);
    EXPECT_LT(found->median, 0.4);
    EXPECT_NEAR(found->dispersion, least_dispersion, 1e-9);
    EXPECT_FALSE(fit_lognormal(std::vector<Trials>{{0.1, 0, 16}, {0.2, 7, 16}}));
    EXPECT_FALSE(fit_lognormal(std::vector<Trials>{{0.1, 0, 16}, {0.2, 0, 16}}));
    EXPECT_FALSE(fit_lognormal({}));
    const auto always = fit_lognormal(std::vector<Trials>{{0.1, 16, 16}, {0.2, 16, 16}});
    ASSERT_TRUE(always);
    EXPECT_LT(always->median, 0.1);
}

// Where rates fall as a power k of the peaks, rate(x) = c x^-k, that of a lognormal chance is
// rate(median) exp(k^2 dispersion^2 / 2) (Cornell 1996).
TEST(Fragility, RateOfFallsByCornell) {
    HazardCurve hazard;
    for (double x = 0.001; x < 10; x *= 1.5) {
        hazard.pga_g.push_back(x);
        hazard.per_year.push_back(1e-4 * std::pow(x, -2.5));
    }
    for (const double dispersion : {0.2, 0.4, 0.6}) {
        Fragility f;
        f.pga_g = 0.5;
        f.pga_dispersion = dispersion;
        const double want =
            1e-4 * std::pow(0.5, -2.5) * std::exp(2.5 * 2.5 * dispersion * dispersion / 2);
        EXPECT_NEAR(falls_per_year(hazard, f) / want, 1, 0.01) << dispersion;
    }
    Fragility counted;
    counted.counted = {{0.1, 0}, {0.2, 1}, {0.4, 1}};
    EXPECT_LT(falls_per_year(hazard, counted), 1e-4 * std::pow(0.1, -2.5));
    EXPECT_GT(falls_per_year(hazard, counted), 1e-4 * std::pow(0.2, -2.5));
    EXPECT_EQ(falls_per_year(hazard, {}), 0);
    // What falls in weaker shakings than the curve's first.
    EXPECT_TRUE(falls_below(counted, 0.11));
    EXPECT_FALSE(falls_below(counted, 0.1));
    EXPECT_FALSE(falls_below({}, 0.1));
}

TEST(Fragility, WhatSlidesIsToldHowItWouldFareWhereItCant) {
    const auto device = device::open_native(2);
    test::Room room(0.02);
    room.floor(0, 2, 0, 2);
    const auto box = static_cast<std::size_t>(room.box(0.5, 0.6, 0.5, 0.6, 0, 0.26, false));
    const auto surroundings = room.surroundings();
    const auto on = [&](double friction) {
        return earthquake_field(*device, surroundings, room.objects, friction, {}).fragility[box];
    };
    const Fragility slippery = on(0.3), firm = on(2);  // b / h is 0.38
    EXPECT_EQ(slippery.counted.back().chance, 0);
    EXPECT_TRUE(std::isnan(slippery.pga_g));
    EXPECT_EQ(slippery.firm_pga_g, firm.pga_g);
    EXPECT_GT(firm.pga_g, 0.38);
    EXPECT_LT(firm.pga_g, 1.5);
}

TEST(Fragility, MediansOfCountsThatLevelOff) {
    Fragility f;
    f.counted = {{0.1, 0}, {0.2, 0.25}, {0.4, 0.75}, {0.8, 0.7}};
    EXPECT_NEAR(half_falls_g(f), std::sqrt(0.2 * 0.4), 1e-12);
    f.counted = {{0.1, 0}, {0.2, 0.4}};
    EXPECT_TRUE(std::isnan(half_falls_g(f)));
    f.counted = {{0.1, 0.6}};
    EXPECT_EQ(half_falls_g(f), 0.1);
    EXPECT_TRUE(std::isnan(half_falls_g({})));
}

TEST(Fragility, OfWhatAlwaysFallsIsTheWeakestThatWasTried) {
    const std::vector<Trials> always{{0.05, 64, 64}, {0.1, 64, 64}, {0.2, 64, 64}};
    const Fragility f = fragility_of(always);
    EXPECT_EQ(f.pga_g, 0.05);
    EXPECT_TRUE(std::isnan(f.pga_dispersion));
    // Nobody knows how weak a shaking it stands: all of them count.
    const HazardCurve hazard{{0.01, 0.1}, {0.1, 0.002}, ""};
    EXPECT_NEAR(falls_per_year(hazard, f), 0.1, 1e-9);
}

TEST(Fragility, SlenderThingsFallEarlierAndAmplifiedFloorsSooner) {
    const auto device = device::open_native(2);
    test::Room room(0.02);
    room.floor(0, 4, 0, 2);
    const auto slender = static_cast<std::size_t>(room.box(0.5, 0.7, 0.5, 0.7, 0, 1.2, false)),
               stout = static_cast<std::size_t>(room.box(2.0, 2.36, 0.5, 0.86, 0, 1.2, false)),
               squat = static_cast<std::size_t>(room.box(3.0, 3.5, 0.5, 1.0, 0, 0.2, false));
    const auto surroundings = room.surroundings();
    EarthquakeOptions options;
    options.hazard = HazardCurve{{0.05, 0.2, 1.0}, {0.05, 0.005, 1e-4}, ""};
    const auto fragility = [&] {
        return earthquake_field(*device, surroundings, room.objects, 0.5, options).fragility;
    };
    const std::vector<Fragility> ground = fragility();
    EXPECT_GT(ground[slender].pga_g, 0.05);
    EXPECT_LT(1.3 * ground[slender].pga_g, ground[stout].pga_g);
    EXPECT_LT(1.3 * ground[slender].pgv_m_s, ground[stout].pgv_m_s);
    EXPECT_GT(ground[slender].falls_per_year, ground[stout].falls_per_year);
    EXPECT_NEAR(ground[slender].return_years * ground[slender].falls_per_year, 1, 1e-9);
    EXPECT_TRUE(std::isnan(ground[squat].pga_g)) << "it slides on a floor without an end";
    EXPECT_EQ(ground[squat].counted.back().chance, 0);
    // What does not slide in any case is no firmer on firmer ground.
    EXPECT_EQ(ground[slender].firm_pga_g, ground[slender].pga_g);
    EXPECT_GT(ground[stout].firm_pga_g, 1.3 * ground[slender].firm_pga_g);
    EXPECT_TRUE(ground[0].counted.empty()) << "the floor";
    options.floor_amplification = 2;
    options.hazard.reset();
    const std::vector<Fragility> upstairs = fragility();
    EXPECT_NEAR(upstairs[slender].pga_g / ground[slender].pga_g, 0.5, 0.05);
    EXPECT_TRUE(std::isnan(upstairs[slender].falls_per_year));
}

}  // namespace
}  // namespace topple::safety
