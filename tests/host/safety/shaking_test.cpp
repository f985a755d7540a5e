// SPDX-License-Identifier: MIT
#include "safety/earthquake/shaking.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "core/random.h"
#include "device/devices.h"
#include "physics/landscape.h"
#include "room.h"
#include "safety/earthquake/earthquake_field.h"
#include "safety/fields.h"
#include "safety/objects.h"

namespace topple::safety {
namespace {

using physics::gravity;
constexpr double slip = 0.3;

Profile upright(double b, double h) {
    return {b, b, h, std::sqrt((b * b + h * h) / 3)};
}

Accelerogram record_of(std::vector<double> values, double step_s) {
    Accelerogram record;
    record.m_s2 = std::move(values);
    record.step_s = step_s;
    return record;
}

// Of acceleration `a` and length t, in a record of 2 t. The last of its samples is where it falls
// to 0 within a step, which then counts half.
Accelerogram pulse(double a, double t, int samples = 2000) {
    const double step_s = t / (samples + 0.5);
    std::vector<double> values(static_cast<std::size_t>(2 * samples), 0.0);
    std::fill_n(values.begin(), samples + 1, a);
    return record_of(std::move(values), step_s);
}

// Strong shaking of a few periods, its peak 1.
Accelerogram shaking(std::uint64_t seed) {
    Random random(seed);
    std::vector<double> values(600, 0.0);
    for (int wave = 0; wave < 8; ++wave) {
        const double period_s = random.uniform(0.2, 1.5), phase = random.uniform(0, 6.28);
        for (std::size_t n = 0; n < values.size(); ++n) {
            const double t = 0.02 * static_cast<double>(n);
            values[n] += std::sin(2 * std::numbers::pi * t / period_s + phase) *
                         std::sin(std::numbers::pi * t / 12);
        }
    }
    Accelerogram record = record_of(std::move(values), 0.02);
    const double peak = record.peak_m_s2();
    for (double& a : record.m_s2) a /= peak;
    return record;
}

Accelerogram scaled(Accelerogram record, double by) {
    for (double& a : record.m_s2) a *= by;
    return record;
}

TEST(Rocking, StartsWhereWestSaysAndOnlyBelowTheFrictionAngle) {
    const double b = 0.05, h = 0.25, west = gravity * b / h;
    EXPECT_EQ(rock(upright(b, h), pulse(0.98 * west, 0.5), slip).energy_J_kg, 0);
    EXPECT_GT(rock(upright(b, h), pulse(1.02 * west, 0.5), slip).energy_J_kg, 0);
    EXPECT_EQ(rock(upright(b, h), pulse(-0.98 * west, 0.5), slip).energy_J_kg, 0);
    EXPECT_GT(rock(upright(b, h), pulse(-1.02 * west, 0.5), slip).energy_J_kg, 0);
    EXPECT_EQ(slide(upright(b, h), pulse(9, 0.5), slip).ahead_m, 0) << "it rocks";
    EXPECT_EQ(rock(upright(0.31 * h, h), pulse(9, 0.5), slip).energy_J_kg, 0) << "it slides";
    EXPECT_GT(slide(upright(0.31 * h, h), pulse(1.02 * slip * gravity, 0.5), slip).ahead_m, 0);
    EXPECT_EQ(slide(upright(0.31 * h, h), pulse(0.98 * slip * gravity, 0.5), slip).ahead_m, 0);
}

// p t = ln(eta / (eta - 1)) of slender blocks (Housner 1963), either way.
TEST(Rocking, OverturnsAtHousnersPulse) {
    const double alpha = 0.05, h = 1.0, b = h * std::tan(alpha);
    const double p = std::sqrt(3 * gravity / (4 * std::hypot(b, h)));
    double worst = 0;
    for (const double way : {1.0, -1.0}) {
        for (const double eta : {1.1, 1.5, 2.0, 4.0}) {
            double low = 0, high = 5;
            for (int n = 0; n < 30; ++n) {
                const double t = (low + high) / 2;
                const Accelerogram record = pulse(way * eta * gravity * b / h, t);
                (rock(upright(b, h), record, slip).overturns ? high : low) = t;
            }
            const double expected = std::log(eta / (eta - 1));
            worst = std::max(worst, std::fabs(p * high / expected - 1));
        }
    }
    std::printf("pulses that just overturn: off by %.4f at most\n", worst);
    EXPECT_LE(worst, 0.02);
}

// It comes down ahead with all the energy E of its swing, and goes over the other edge if what is
// left of that suffices: for a rectangle, 1 - 1.5 sin^2 alpha of the speed is.
TEST(Rocking, KeepsTheAngularMomentumAboutTheOtherEdge) {
    const double h = 0.5, ahead = 0.12, k2 = (ahead * ahead + h * h) / 3;
    const Accelerogram once = pulse(1.5 * gravity * ahead / h, 0.15, 4000);
    const auto body = [&](double behind) { return Profile{ahead, behind, h, std::sqrt(k2)}; };
    const double energy = rock(body(ahead), once, slip).energy_J_kg;
    EXPECT_FALSE(rock(body(ahead), once, slip).overturns);
    double low = 1e-3, high = ahead;
    for (int n = 0; n < 40; ++n) {
        const double behind = (low + high) / 2;
        (rock(body(behind), once, slip).overturns ? low : high) = behind;
    }
    const auto inertia = [&](double b) { return k2 + h * h + b * b; };
    const double kept = (k2 + h * h - ahead * high) / inertia(high);
    EXPECT_NEAR(energy * kept * kept * inertia(high) / inertia(ahead),
                gravity * (std::hypot(high, h) - h), 0.02 * energy);
    EXPECT_LT(high, 0.9 * ahead);
    // The same share for a rectangle as Housner has it.
    const double s = std::sin(std::atan(ahead / h));
    EXPECT_NEAR((k2 + h * h - ahead * ahead) / inertia(ahead), 1 - 1.5 * s * s, 1e-12);
}

// Many impacts make the motion sensitive, in nature too: single bodies may differ.
TEST(Rocking, ConvergesWithItsSteps) {
    Random random(3);
    int falls = 0, alike = 0;
    constexpr int all = 150;
    std::vector<double> off;
    for (int n = 0; n < all; ++n) {
        const double h = random.uniform(0.05, 0.8), alpha = random.uniform(0.05, 0.28);
        const Profile body = upright(h * alpha, h);
        const Accelerogram record = scaled(shaking(static_cast<std::uint64_t>(n)),
                                           gravity * alpha * random.uniform(0.9, 2.5));
        const Rocking plain = rock(body, record, slip), fine = rock(body, record, slip, 0.002);
        falls += fine.overturns;
        alike += plain.overturns == fine.overturns;
        if (!plain.overturns && !fine.overturns && fine.energy_J_kg > 0)
            off.push_back(std::fabs(plain.energy_J_kg / fine.energy_J_kg - 1));
    }
    std::sort(off.begin(), off.end());
    const double median = off[off.size() / 2];
    std::printf("%d of %d overturn; %d alike in finer steps; median of energies %.4f off\n", falls,
                all, alike, median);
    EXPECT_GE(falls, 50);
    EXPECT_LE(falls, 130);
    EXPECT_GE(off.size(), 20u);
    EXPECT_GE(alike, 143);  // 95 %
    EXPECT_LE(median, 0.02);
}

TEST(SlidingOnShaking, MatchesNewmark) {
    // s = (a - mu g) a t^2 / (2 mu g)
    double worst = 0;
    for (const double a : {3.1, 4.0, 6.0, 12.0}) {
        const double t = 0.3, s = (a - slip * gravity) * a * t * t / (2 * slip * gravity);
        const Sliding ahead = slide(upright(1, 0.2), pulse(a, t), slip);
        const Sliding behind = slide(upright(1, 0.2), pulse(-a, t), slip);
        worst = std::max(worst, std::fabs(ahead.ahead_m / s - 1));
        EXPECT_EQ(ahead.ahead_m, behind.behind_m);
        EXPECT_EQ(ahead.behind_m, 0);
    }
    std::printf("sliding: off by %.5f at most\n", worst);
    EXPECT_LE(worst, 0.02);
}

// Straight between samples, so that steps of microseconds must find the same.
TEST(SlidingOnShaking, MatchesIntegration) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        const Accelerogram record = scaled(shaking(seed), 6);
        double place = 0, speed = 0, most = 0, least = 0;
        const int parts = 2000;
        const double dt = record.step_s / parts;
        for (std::size_t n = 0; n + 1 < record.m_s2.size(); ++n) {
            for (int part = 0; part < parts; ++part) {
                const double a =
                    record.m_s2[n] + (record.m_s2[n + 1] - record.m_s2[n]) * (part + 0.5) / parts;
                if (speed == 0 && std::fabs(a) <= slip * gravity) continue;
                const double way = speed != 0 ? std::copysign(1.0, speed) : std::copysign(1.0, a);
                const double next = speed + (a - way * slip * gravity) * dt;
                speed = next * way <= 0 ? 0 : next;
                place += speed * dt;
                most = std::max(most, place);
                least = std::min(least, place);
            }
        }
        const Sliding exact = slide(upright(1, 0.1), record, slip);
        EXPECT_NEAR(exact.ahead_m, most, 2e-3 * (most - least)) << seed;
        EXPECT_NEAR(exact.behind_m, -least, 2e-3 * (most - least)) << seed;
        EXPECT_GT(most - least, 0.01);
    }
}

TEST(EarthquakeRecord, SixteenDirectionsOfTheSameRecord) {
    const auto device = device::open_native(2);
    test::Room room(0.02);
    room.floor(0, 2, 0, 2);
    // Slender along x alone.
    const auto id = static_cast<std::size_t>(room.box(0.9, 1.0, 0.6, 1.4, 0, 0.6, false));
    RiskObject& plate = room.objects[id];
    plate.support_polygon = {{0.9, 0.6}, {1.0, 0.6}, {1.0, 1.4}, {0.9, 1.4}};
    plate.barrier_J = tipping_energy(plate.mass_kg, 0.3, 0.05);
    EarthquakeOptions options;
    options.record = pulse(0.25 * gravity, 0.6);
    const auto surroundings = room.surroundings();
    const Disturbance field = earthquake_field(*device, surroundings, room.objects, slip, options);
    EXPECT_EQ(field.draws, 16u);
    ASSERT_EQ(field.work[id].size(), 16u);
    EXPECT_NEAR(test::total_probability(field.work[id]), 1, 1e-12);
    EXPECT_GE(field.work[id][0].W_J, plate.barrier_J) << "across";
    EXPECT_GE(field.work[id][8].W_J, plate.barrier_J) << "across, the other way";
    EXPECT_LT(field.work[id][4].W_J, plate.barrier_J) << "along";
    options.seed = 7;
    const Disturbance again = earthquake_field(*device, surroundings, room.objects, slip, options);
    for (unsigned d = 0; d < direction_count; ++d) {
        EXPECT_EQ(again.work[id][d].W_J, field.work[id][d].W_J);
        EXPECT_NEAR(field.work[id][d].direction[0], direction(d)[0], 1e-12);
    }
}

// 200 objects in 16 directions, 31 s.
TEST(EarthquakeRecord, ARoomfulIsFast) {
    const auto device = device::open_native(2);
    test::Room room(0.05);
    room.floor(0, 10, 0, 5);
    Random random(1);
    for (int n = 0; n < 200; ++n) {
        const double x = 0.25 + 0.5 * (n % 20), y = 0.25 + 0.5 * (n / 20);
        const double height = 0.05 * std::round(random.uniform(4, 40));
        const auto id = static_cast<std::size_t>(
            room.box(x - 0.1, x + 0.1, y - 0.05, y + 0.05, 0, height, false));
        // Somewhat askew, so that no two are alike.
        const double a = x - random.uniform(0.06, 0.1), b = x + random.uniform(0.06, 0.1);
        const double c = y - random.uniform(0.03, 0.05), d = y + random.uniform(0.03, 0.05);
        room.objects[id].support_polygon = {{a, c}, {b, c}, {b, d}, {a, d}};
    }
    Accelerogram record = scaled(shaking(1), 3.1);
    const std::vector<double> once = record.m_s2;
    while (record.duration_s() < 31)
        record.m_s2.insert(record.m_s2.end(), once.begin(), once.end());
    EarthquakeOptions options;
    options.record = record;
    const auto surroundings = room.surroundings();
    const auto start = std::chrono::steady_clock::now();
    const Disturbance field = earthquake_field(*device, surroundings, room.objects, slip, options);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("200 objects, 16 directions, %.0f s of shaking: %.3f s\n", record.duration_s(),
                seconds);
    double energy = 0;
    for (const auto& work : field.work)
        for (const auto& sample : work) energy += sample.W_J;
    EXPECT_GT(energy, 0);
    EXPECT_LT(seconds, 2);  // in a tenth of that on two idle cores
}

}  // namespace
}  // namespace topple::safety
