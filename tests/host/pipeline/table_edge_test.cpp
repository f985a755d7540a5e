// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "device/devices.h"
#include "host/pipeline/assessed_room.h"
#include "physics/directions.h"
#include "safety/earthquake/earthquake_field.h"

namespace topple::safety {
namespace {

constexpr double mu = 0.3, gravity = 9.80665;

// A flat box by the edge of a table, which lies beyond it towards +x: a pulse that throws it there
// or nearly there pushes it off; one that throws it along the edge, or away from it, does not.
TEST(TableEdge, WhatSlidesAlongItStaysOn) {
    const auto device = device::open_native(1);
    test::Room room(0.02);
    room.floor(0, 3, 0, 3);
    room.box(0.2, 1.4, 0.2, 2.8, 0, 0.4);
    const auto id = static_cast<std::size_t>(room.box(1.2, 1.36, 1.42, 1.58, 0.4, 0.44, false));
    const test::AssessedRoom scene(*device, room, mu);
    const double needs =
        slide_towards_m(scene.at_risk[id], {1, 0, 0}, 0);  // its centre is 12 cm from the edge
    ASSERT_NEAR(needs, 0.12, 0.021);
    // Newmark's s = (a - mu g) a t^2 / (2 mu g) is half as far again.
    const double a = 5, t = std::sqrt(1.5 * needs * 2 * mu * gravity / ((a - mu * gravity) * a));
    EarthquakeOptions options;
    Accelerogram pulse;
    pulse.step_s = t / 100;
    pulse.m_s2.assign(200, 0.0);
    std::fill_n(pulse.m_s2.begin(), 100, a);
    options.record = pulse;
    const Disturbance field = earthquake_field(*device, scene.around, scene.at_risk, mu, options);
    ASSERT_EQ(field.work[id].size(), direction_count);
    for (unsigned d = 0; d < direction_count; ++d) {
        SCOPED_TRACE(d);
        const bool falls = instability(scene.at_risk[id], field.work[id][d]) > 0;
        const double towards = direction(d)[0];
        EXPECT_EQ(falls, 1.5 * towards > 1) << towards;
    }
}

}  // namespace
}  // namespace topple::safety
