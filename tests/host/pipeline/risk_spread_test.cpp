// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "assessed_room.h"
#include "device/devices.h"
#include "safety/earthquake/earthquake_field.h"
#include "safety/human/human_field.h"

namespace topple::test {
namespace {

// Over many seeds, a risk strays from its mean by about as much as its standard error says.
TEST(RiskSpread, IsWhatSeedsDifferBy) {
    const auto device = device::open_native(2);
    Room room(0.025);
    room.floor(-1.5, 1.5, -1.5, 1.5);
    room.box(-0.6, 0.6, -0.4, 0.4, 0.7, 0.75);
    const auto cup = static_cast<std::size_t>(room.box(0.5, 0.6, 0, 0.1, 0.75, 0.95, false));
    const AssessedRoom scene(*device, room, 0.3);
    constexpr std::uint64_t seeds = 30;
    const auto strays = [&](const std::function<safety::Disturbance(std::uint64_t)>& field) {
        double sum = 0, square = 0, told = 0;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            const safety::Risk r = safety::risk(field(seed), scene.at_risk)[cup];
            sum += r.mean_J;
            square += r.mean_J * r.mean_J;
            told += r.spread_J / seeds;
        }
        const double mean = sum / seeds;
        EXPECT_GT(mean, 0);
        return std::sqrt((square / seeds - mean * mean) * seeds / (seeds - 1)) / told;
    };
    const double walks = strays([&](std::uint64_t seed) {
        safety::HumanOptions options;
        options.seed = seed;
        options.paths = 100;
        return safety::human_field(*device, scene.around, scene.at_risk, options);
    });
    EXPECT_GT(walks, 0.45);
    EXPECT_LT(walks, 1.4);
    const double shakes = strays([&](std::uint64_t seed) {
        safety::EarthquakeOptions options;
        options.seed = seed;
        return safety::earthquake_field(*device, scene.around, scene.at_risk, 0.3, options);
    });
    EXPECT_GT(shakes, 0.7);
    EXPECT_LT(shakes, 1.4);
}

}  // namespace
}  // namespace topple::test
