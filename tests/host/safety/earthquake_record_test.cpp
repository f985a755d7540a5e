// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "device/devices.h"
#include "physics/landscape.h"
#include "room.h"
#include "safety/fields.h"
#include "safety/objects.h"

namespace topple::safety {
namespace {

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

}  // namespace
}  // namespace topple::safety
