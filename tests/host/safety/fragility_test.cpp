// SPDX-License-Identifier: MIT
#include "safety/earthquake/fragility.h"

#include "core/random.h"
#include "device/devices.h"
#include "physics/landscape.h"
#include "room.h"
#include "safety/earthquake/made_up_records.h"
#include "safety/objects.h"
#include "testing.h"

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
    test::Room room(0.02, {0, 0}, {2, 2});
    const auto box = static_cast<std::size_t>(room.box(0.5, 0.6, 0.5, 0.6, 0, 0.26, false));
    const auto surroundings = room.surroundings();
    const auto on = [&](double friction) {
        room.objects[box].friction = friction;
        return earthquake_field(*device, surroundings, room.objects, {}).fragility[box];
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
    test::Room room(0.02, {0, 0}, {4, 2});
    const auto slender = static_cast<std::size_t>(room.box(0.5, 0.7, 0.5, 0.7, 0, 1.2, false)),
               stout = static_cast<std::size_t>(room.box(2.0, 2.36, 0.5, 0.86, 0, 1.2, false)),
               squat = static_cast<std::size_t>(room.box(3.0, 3.5, 0.5, 1.0, 0, 0.2, false));
    const auto surroundings = room.surroundings();
    EarthquakeOptions options;
    options.hazard = HazardCurve{{0.05, 0.2, 1.0}, {0.05, 0.005, 1e-4}, ""};
    for (RiskObject& object : room.objects) object.friction = 0.5;
    const auto fragility = [&] {
        return earthquake_field(*device, surroundings, room.objects, options).fragility;
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

double root_mean_square(const std::vector<double>& values, std::size_t from, std::size_t to) {
    double sum = 0;
    for (std::size_t n = from; n < to; ++n) sum += values[n] * values[n];
    return std::sqrt(sum / static_cast<double>(to - from));
}

// Of an oscillator of that period and 5 % damping, m/s^2, in steps of a tenth of the record's.
double response_m_s2(const std::vector<double>& m_s2, double step_s, double period_s) {
    const double w = 2 * std::numbers::pi / period_s, dt = step_s / 10;
    double x = 0, v = 0, most = 0;
    for (std::size_t n = 0; n + 1 < m_s2.size(); ++n) {
        for (int k = 0; k < 10; ++k) {
            const double a = m_s2[n] + (m_s2[n + 1] - m_s2[n]) * (k + 0.5) / 10;
            v += (-a - 2 * 0.05 * w * v - w * w * x) * dt;
            x += v * dt;
        }
        most = std::max(most, std::fabs(x));
    }
    return w * w * most;
}

// Eurocode 8's type 1 spectrum over the peak acceleration (EN 1998-1, 3.2.2.2).
double eurocode(double tb, double tc, double td, double period_s) {
    if (period_s < tb) return 1 + period_s / tb * 1.5;
    if (period_s < tc) return 2.5;
    return period_s < td ? 2.5 * tc / period_s : 2.5 * tc * td / (period_s * period_s);
}

TEST(MadeUpRecords, AreTheSameFromASeed) {
    const auto all = made_up_records(15, 5), few = made_up_records(3, 5),
               others = made_up_records(3, 6);
    ASSERT_EQ(all.size(), 15u);
    for (std::size_t n = 0; n < few.size(); ++n) {
        EXPECT_EQ(all[n].m_s2, few[n].m_s2);
        EXPECT_EQ(all[n].across_m_s2, few[n].across_m_s2);
        EXPECT_EQ(all[n].up_m_s2, few[n].up_m_s2);
        EXPECT_NE(all[n].m_s2, others[n].m_s2);
    }
    EXPECT_NE(all[0].m_s2, all[5].m_s2) << "the same ground type";
}

TEST(MadeUpRecords, SwellFadeAndLeaveTheGroundAtRest) {
    for (const Accelerogram& r : made_up_records(15, 1)) {
        EXPECT_NEAR(r.peak_m_s2(), 1, 1e-12);
        ASSERT_EQ(r.across_m_s2.size(), r.m_s2.size());
        ASSERT_EQ(r.up_m_s2.size(), r.m_s2.size());
        double up = 0, velocity = 0;
        for (const double a : r.up_m_s2) up = std::max(up, std::fabs(a));
        for (const double a : r.m_s2) velocity += a * r.step_s;
        EXPECT_NEAR(up, 2.0 / 3, 1e-12);
        // What is left of the motion is a swing of the slow filter, which fades.
        EXPECT_LT(std::fabs(velocity), 0.25 * peak_velocity_m_s(r)) << r.source;
        const std::size_t end = r.m_s2.size();
        EXPECT_LT(root_mean_square(r.m_s2, 0, 50), 0.5 * root_mean_square(r.m_s2, 200, 400));
        EXPECT_LT(root_mean_square(r.m_s2, end - 100, end),
                  0.6 * root_mean_square(r.m_s2, 200, 400));
    }
}

// The mean spectra are Eurocode 8's: at most a third off at any period, a sixth in the mean, but
// for one factor of all of a ground type.
TEST(MadeUpRecords, HaveEurocodesSpectra) {
    constexpr int each = 20;
    const auto records = made_up_records(5 * each, 2);
    const double corners[5][3] = {
        {0.15, 0.4, 2}, {0.15, 0.5, 2}, {0.2, 0.6, 2}, {0.2, 0.8, 2}, {0.15, 0.5, 2}};
    for (std::size_t type = 0; type < 5; ++type) {
        std::vector<double> off;
        for (const double period_s : {0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0}) {
            double mean = 0;
            for (std::size_t n = type; n < records.size(); n += 5)
                mean += response_m_s2(records[n].m_s2, records[n].step_s, period_s) / each;
            const auto& [tb, tc, td] = corners[type];
            off.push_back(std::log(mean / eurocode(tb, tc, td, period_s)));
        }
        double factor = 0, spread = 0, worst = 0;
        for (const double o : off) factor += o / static_cast<double>(off.size());
        for (const double o : off) {
            spread += std::fabs(o - factor) / static_cast<double>(off.size());
            worst = std::max(worst, std::fabs(o - factor));
        }
        std::printf("ground type %c: %.3f times the spectrum, %.3f off in the mean, %.3f at most\n",
                    static_cast<char>('A' + type), std::exp(factor), spread, worst);
        EXPECT_LT(worst, std::log(4.0 / 3));
        EXPECT_LT(spread, std::log(7.0 / 6));
        EXPECT_NEAR(factor, 0, std::log(1.35));
    }
}

using physics::gravity;
constexpr double slip = 0.3;

// Of acceleration `a` and length t, in a record of 2 t. The last of its samples is where it falls
// to 0 within a step, which then counts half.
Accelerogram pulse(double a, double t, int samples = 2000) {
    Accelerogram record;
    record.step_s = t / (samples + 0.5);
    record.m_s2.assign(static_cast<std::size_t>(2 * samples), 0.0);
    std::fill_n(record.m_s2.begin(), samples + 1, a);
    return record;
}

TEST(EarthquakeRecord, SixteenDirectionsOfTheSameRecord) {
    const auto device = device::open_native(2);
    test::Room room(0.02, {0, 0}, {2, 2});
    // Slender along x alone.
    const auto id = static_cast<std::size_t>(room.box(0.9, 1.0, 0.6, 1.4, 0, 0.6, false));
    RiskObject& plate = room.objects[id];
    plate.friction = slip;
    plate.support_polygon = {{0.9, 0.6}, {1.0, 0.6}, {1.0, 1.4}, {0.9, 1.4}};
    plate.barrier_J = tipping_energy(plate.mass_kg, 0.3, 0.05);
    EarthquakeOptions options;
    options.record = pulse(0.25 * gravity, 0.6);
    const auto surroundings = room.surroundings();
    const Disturbance field = earthquake_field(*device, surroundings, room.objects, options);
    EXPECT_EQ(field.draws, 16u);
    ASSERT_EQ(field.work[id].size(), 16u);
    EXPECT_NEAR(test::total_probability(field.work[id]), 1, 1e-12);
    EXPECT_GE(field.work[id][0].W_J, plate.barrier_J) << "across";
    EXPECT_GE(field.work[id][8].W_J, plate.barrier_J) << "across, the other way";
    EXPECT_LT(field.work[id][4].W_J, plate.barrier_J) << "along";
    options.seed = 7;
    const Disturbance again = earthquake_field(*device, surroundings, room.objects, options);
    for (unsigned d = 0; d < direction_count; ++d) {
        EXPECT_EQ(again.work[id][d].W_J, field.work[id][d].W_J);
        EXPECT_NEAR(std::abs(field.work[id][d].direction[0]), 1, 1e-12) << "over its long edges";
    }
}

}  // namespace
}  // namespace topple::safety
