// SPDX-License-Identifier: MIT
#include "physics/overturning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "device/devices.h"

namespace topple::physics {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

// A bookcase of 30 kg: 0.8 m wide, 0.3 m deep, 1.8 m high, on a floor 0.2 m up.
constexpr double width = 0.8, depth = 0.3, height = 1.8, floor_m = 0.2, mass = 30;

Candidate bookcase() {
    Candidate out;
    out.primitives = {0};
    out.body.mass_kg = mass;
    out.body.center = {0, 0, floor_m + height / 2};
    out.support_polygon = {{-width / 2, -depth / 2},
                           {width / 2, -depth / 2},
                           {width / 2, depth / 2},
                           {-width / 2, depth / 2}};
    out.support_height_m = floor_m;
    out.stood = true;
    return out;
}

Stability tipping_of(const Candidate& candidate) {
    std::vector<std::vector<Vec3>> vertices(1);
    for (unsigned c = 0; c < 8; ++c)
        vertices[0].push_back({(c & 1 ? 0.5 : -0.5) * width, (c & 2 ? 0.5 : -0.5) * depth,
                               floor_m + (c & 4 ? height : 0)});
    const auto device = device::open_native(1);
    const SupportTable table(*device, vertices, 0, geodesic_sphere(8));
    return evaluate(*device, table, std::span(&candidate, 1), Passes::exact)[0];
}

TEST(Overturning, ABookcaseAsStaticsHasIt) {
    const Candidate candidate = bookcase();
    const Overturning o =
        overturning(candidate, {}, tipping_of(candidate), floor_m + height, 0, 0.3, floor_m);
    EXPECT_NEAR(o.tilt_deg, std::atan(depth / height) * degrees, 1e-3);
    EXPECT_NEAR(std::abs(o.direction[1]), 1, 1e-6);
    EXPECT_NEAR(o.push_N, mass * gravity * (depth / 2) / height, 1e-2);
    EXPECT_NEAR(o.slide_N, 0.3 * mass * gravity, 1e-9);
    EXPECT_NEAR(o.shake_g, depth / height, 1e-5);
    EXPECT_NEAR(o.push_error_N, foot_off_share * o.push_N, 1e-6);
    // On a smooth floor it slides before it rocks.
    EXPECT_NEAR(overturning(candidate, {}, tipping_of(candidate), 2, 0, 0.1, floor_m).shake_g, 0.1,
                1e-9);
}

TEST(Overturning, ErrorsAreThoseOfBorderHeightAndMass) {
    const double border = 0.008, high = 0.05, heavy = 2;
    const Candidate candidate = bookcase();
    const Overturning o = overturning(candidate, {heavy, {0, 0, high}}, tipping_of(candidate),
                                      floor_m + height, border, 0.3, floor_m);
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    double tilt = 0, tilt2 = 0, push = 0, push2 = 0;
    constexpr int draws = 200000;
    for (int n = 0; n < draws; ++n) {
        const double b =
            depth / 2 * (1 + foot_off_share * normal(random)) + border * normal(random);
        const double h = height / 2 + high * normal(random);
        const double m = mass + heavy * normal(random);
        const double t = std::atan(b / h) * degrees, p = m * gravity * b / height;
        tilt += t / draws;
        tilt2 += t * t / draws;
        push += p / draws;
        push2 += p * p / draws;
    }
    EXPECT_NEAR(o.tilt_error_deg, std::sqrt(tilt2 - tilt * tilt), 0.06 * o.tilt_error_deg);
    EXPECT_NEAR(o.push_error_N, std::sqrt(push2 - push * push), 0.03 * o.push_error_N);
}

// A metre above the floor, at the top of what is lower, and at the middle of what is out of reach.
TEST(Overturning, AHandReachesAMetreUp) {
    const Candidate candidate = bookcase();
    const Stability tipping = tipping_of(candidate);
    const auto pushed = [&](double people_on_m) {
        return overturning(candidate, {}, tipping, floor_m + height, 0.01, 0.3, people_on_m);
    };
    const double moment = mass * gravity * depth / 2;
    const Overturning o = pushed(floor_m);
    EXPECT_NEAR(o.hand_height_m, 1, 1e-12);
    EXPECT_NEAR(o.hand_push_N, moment, 1e-2);
    EXPECT_NEAR(o.hand_push_error_N,
                std::hypot(mass * gravity * 0.01, foot_off_share * o.hand_push_N), 1e-6);
    EXPECT_NEAR(pushed(floor_m + 2).hand_push_N, o.push_N, 1e-9);
    EXPECT_NEAR(pushed(floor_m - 0.4).hand_push_N, moment / 0.6, 2e-2);
    EXPECT_NEAR(pushed(floor_m - 1.5).hand_height_m, height / 2, 1e-9);
}

TEST(Overturning, WhatFallsByItselfTakesNothing) {
    Candidate candidate = bookcase();
    for (auto& corner : candidate.support_polygon) corner[1] += depth;
    const Overturning o = overturning(candidate, {}, tipping_of(candidate), 2, 0, 0.3, floor_m);
    EXPECT_EQ(o.tilt_deg, 0);
    EXPECT_EQ(o.push_N, 0);
    EXPECT_EQ(o.shake_g, 0);
}

TEST(Overturning, WhatHangsOrIsHeldByNothingHasNone) {
    Candidate candidate = bookcase();
    const Stability tipping = tipping_of(candidate);
    candidate.support_height_m = 3;
    EXPECT_TRUE(std::isnan(overturning(candidate, {}, tipping, 2, 0, 0.3, floor_m).tilt_deg));
    candidate = bookcase();
    candidate.support_polygon.clear();
    EXPECT_TRUE(std::isnan(overturning(candidate, {}, tipping, 2, 0, 0.3, floor_m).push_N));
}

}  // namespace
}  // namespace topple::physics
