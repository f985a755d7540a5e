// SPDX-License-Identifier: MIT
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
#include "safety/fields.h"
#include "safety/objects.h"

namespace topple::safety {
namespace {

using physics::gravity;
constexpr double slip = 0.3;

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
        EXPECT_NEAR(std::abs(field.work[id][d].direction[0]), 1, 1e-12) << "over its long edges";
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
