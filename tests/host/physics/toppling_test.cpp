// SPDX-License-Identifier: MIT
#include "physics/toppling.h"

#include <chrono>
#include <random>

#include "core/random.h"
#include "host/physics/solids.h"
#include "physics/blow.h"
#include "physics/overturning.h"
#include "testing.h"

namespace topple::physics {
namespace {

constexpr double brick_density = 700, brick_friction = 0.3;

std::vector<std::array<double, 2>> sixteen() {
    std::vector<std::array<double, 2>> out;
    for (int n = 0; n < 16; ++n)
        out.push_back({std::cos(n * std::numbers::pi / 8), std::sin(n * std::numbers::pi / 8)});
    return out;
}

// A box that stands in the middle of nothing: where its support ends is said by `slides`.
struct Brick {
    Candidate candidate;
    Toppling::Extent body;
    Stability tipping;

    Brick(double x, double y, double z) {
        candidate.primitives = {0};
        candidate.body.mass_kg = brick_density * x * y * z;
        candidate.body.center = {0, 0, z / 2};
        candidate.support_polygon = {
            {-x / 2, -y / 2}, {x / 2, -y / 2}, {x / 2, y / 2}, {-x / 2, y / 2}};
        candidate.stood = true;
        const double m = candidate.body.mass_kg / 12;
        body = {{m * (y * y + z * z), m * (x * x + z * z), m * (x * x + y * y), 0, 0, 0}, z};
        std::vector<std::vector<Vec3>> vertices(1);
        for (unsigned c = 0; c < 8; ++c)
            vertices[0].push_back(
                {(c & 1 ? 0.5 : -0.5) * x, (c & 2 ? 0.5 : -0.5) * y, c & 4 ? z : 0});
        tipping = test::stability(vertices, candidate);
    }
    Toppling toppling(const SlideResult& sliding = {}) const {
        return {candidate, body, tipping, sixteen(), sliding, brick_friction};
    }
};

double brick_rise_J(const Brick& brick, double half) {
    const double h = brick.candidate.body.center[2];
    return brick.candidate.body.mass_kg * gravity * (std::hypot(half, h) - h);
}

TEST(Toppling, AboutEachEdgeIsTheClosedFormOfTheBlow) {
    const Brick brick(0.1, 0.16, 0.4);
    const Toppling toppling = brick.toppling();
    const double mass = brick.candidate.body.mass_kg;
    for (const auto& [way, half] : {std::pair{Vec3{1, 0, 0}, 0.05}, {Vec3{0, -1, 0}, 0.08}}) {
        const Upright side{half, half, 0.2, std::sqrt((half * half + 0.04) / 3)};
        for (std::size_t n = 0; n < Toppling::heights; ++n) {
            const double z = toppling.height_m(n);
            EXPECT_DOUBLE_EQ(z, 0.05 * (static_cast<double>(n) + 0.5));
            const double v = std::min(tips_ahead_m_s(side, z, brick_friction),
                                      tips_behind_m_s(side, z, brick_friction));
            EXPECT_NEAR(toppling.blow_barrier_J(way, z) / (mass * v * v / 2 * free_share(side, z)),
                        1, 2e-3)
                << z;
            const double W = toppling.blow_barrier_J(way, z);
            EXPECT_NEAR(toppling.impulse_Ns(W, way, z) / (mass * v), 1, 1e-3) << z;
        }
        EXPECT_NEAR(toppling.push_barrier_J(way), brick_rise_J(brick, half), 1e-6);
    }
}

// The edge ahead is where the line ahead leaves the footing, and a push that tips it over that edge
// has the moment of its weight about where they meet.
TEST(Toppling, TheEdgeAheadIsWhereTheLineLeavesTheFooting) {
    const Brick brick(0.1, 0.16, 0.4);
    const Toppling toppling = brick.toppling();
    for (int n = 0; n < 72; ++n) {
        const double angle = (n + 0.3) * std::numbers::pi / 36, x = std::cos(angle),
                     y = std::sin(angle);
        const bool across = 0.05 / std::abs(x) < 0.08 / std::abs(y);
        const Toppling::EdgeAhead edge = toppling.edge_ahead({x, y, 0});
        EXPECT_NEAR(edge.distance_m, across ? 0.05 / std::abs(x) : 0.08 / std::abs(y), 1e-6);
        EXPECT_NEAR(edge.cosine, across ? std::abs(x) : std::abs(y), 1e-6);
        const MassProperties& body = brick.candidate.body;
        const TippingPush push =
            tipping_push(body, {0.1 * body.mass_kg, {}}, edge.distance_m, edge.cosine, 0, 0.25);
        EXPECT_NEAR(push.push_N, body.mass_kg * gravity * edge.distance_m / 0.25, 1e-9);
        EXPECT_NEAR(push.error_N, push.push_N * std::hypot(foot_off_share, 0.1), 1e-9);
    }
}

// What stands on its edge falls by any push; what hangs from nothing has no edge.
TEST(Toppling, WithoutAnEdgeNothingTips) {
    Brick brick(0.1, 0.16, 0.4);
    brick.tipping.ways.clear();
    EXPECT_EQ(brick.toppling().edge_ahead({1, 0, 0}).distance_m, HUGE_VAL);
    brick.tipping.ways.push_back({});
    EXPECT_EQ(brick.toppling().edge_ahead({1, 0, 0}).distance_m, 0);
}

TEST(Toppling, ABookSlidesOffItsShelfAndTipsNowhere) {
    const Brick book(0.15, 0.22, 0.03);
    SlideResult sliding;
    sliding.straight.assign(16, {});
    sliding.straight[0] = {0.1, 0.5};  // towards +x, half a metre down
    sliding.found = true;
    sliding.distance_m = 0.1;
    const Toppling toppling = book.toppling(sliding);
    const double mass = book.candidate.body.mass_kg;
    const double work = brick_friction * mass * gravity * 0.1;
    EXPECT_NEAR(toppling.push_barrier_J({1, 0, 0}), work, 1e-9);
    // At its middle a blow does nothing but slide it, and turns it on its way at its top.
    EXPECT_NEAR(toppling.blow_barrier_J({1, 0, 0}, 0.015), work, 0.02 * work);
    EXPECT_GT(toppling.blow_barrier_J({1, 0, 0}, 0.03), work);
    EXPECT_EQ(toppling.struck_J(2 * work, {1, 0, 0}, 0.015), mass * gravity * 0.5);
    for (const Vec3& way : {Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}}) {
        EXPECT_TRUE(std::isinf(toppling.push_barrier_J(way)));
        EXPECT_EQ(toppling.struck_J(100 * work, way, 0.015), 0);
    }
    EXPECT_DOUBLE_EQ(toppling.slide_distance_m({1, 0, 0}), 0.1);
    EXPECT_TRUE(std::isinf(toppling.slide_distance_m({0, 1, 0})));
}

// On its long edge the same book tips over its face, and hardly over its spine.
TEST(Toppling, ABookOnItsEdgeFallsOverItsFace) {
    const Brick book(0.03, 0.15, 0.22);
    const Toppling toppling = book.toppling();
    const double face = toppling.blow_barrier_J({1, 0, 0}, 0.18);
    EXPECT_LT(face, 1.3 * brick_rise_J(book, 0.015));
    EXPECT_GT(toppling.blow_barrier_J({0, 1, 0}, 0.18), 15 * face);
}

TEST(Toppling, NoPushAndNoBlowTakesLessThanTheCurveSays) {
    Random random(4);
    for (int n = 0; n < 20; ++n) {
        const Brick brick(random.uniform(0.03, 0.2), random.uniform(0.03, 0.2),
                          random.uniform(0.1, 0.5));
        SlideResult sliding;
        for (int w = 0; w < 16; ++w)
            sliding.straight.push_back({random.uniform(0.2, 1), random.uniform(0.1, 0.8)});
        sliding.found = true;
        sliding.distance_m = 0.2;
        sliding.drop_m = 0.8;
        const double weight = brick.candidate.body.mass_kg * gravity;
        sliding.absorbed_J = brick_friction * weight * 0.2;
        sliding.released_J = weight * 0.8;
        const Instability all = combine_curves(brick.tipping, sliding);
        const Toppling toppling = brick.toppling(sliding);
        const auto envelope = [&](double W) {
            double most = 0;
            for (const InstabilityStep& step : all.curve)
                if (step.W_J <= W * (1 + 1e-9)) most = std::max(most, step.S_J);
            return most * (1 + 1e-9);
        };
        double least = INFINITY;
        for (const auto& [x, y] : sixteen()) {
            const Vec3 way{x, y, 0};
            least = std::min(least, toppling.push_barrier_J(way));
            for (const double W : {0.5, 1.0, 2.0, 8.0, 100.0}) {
                const double joules = W * all.curve.front().W_J;
                EXPECT_LE(toppling.pushed_J(joules, way), envelope(joules)) << n;
                for (std::size_t h = 0; h < Toppling::heights; ++h)
                    EXPECT_LE(toppling.struck_J(joules, way, toppling.height_m(h)),
                              envelope(joules))
                        << n;
            }
        }
        // One of the directions is the easiest one, that of an edge.
        EXPECT_NEAR(least, all.curve.front().W_J, 1e-6 * least) << n;
    }
}

TEST(Toppling, ATableOfAThousandIsQuick) {
    Random random(2);
    std::vector<Brick> bricks;
    for (int n = 0; n < 20; ++n)
        bricks.emplace_back(random.uniform(0.03, 0.2), random.uniform(0.03, 0.2),
                            random.uniform(0.1, 0.5));
    const auto start = std::chrono::steady_clock::now();
    double sum = 0;
    for (int n = 0; n < 1000; ++n) {
        const Toppling toppling = bricks[n % 20].toppling();
        for (const auto& [x, y] : sixteen()) {
            for (std::size_t h = 0; h < Toppling::heights; ++h)
                sum += std::min(toppling.blow_barrier_J({x, y, 0}, toppling.height_m(h)), 1e9);
        }
    }
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("1,000 objects x 16 directions x 8 heights: %.0f ms (%g)\n", 1000 * seconds, sum);
    EXPECT_LT(seconds, 2);
}

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
    return test::stability(vertices, candidate);
}

TEST(Overturning, ABookcaseAsStaticsHasIt) {
    const Candidate candidate = bookcase();
    const Overturning o =
        overturning(candidate, {}, tipping_of(candidate), floor_m + height, 0, {0.3, 0}, floor_m);
    EXPECT_NEAR(o.tilt_deg, std::atan(depth / height) * degrees, 1e-3);
    EXPECT_NEAR(std::abs(o.direction[1]), 1, 1e-6);
    EXPECT_NEAR(o.push_N, mass * gravity * (depth / 2) / height, 1e-2);
    EXPECT_NEAR(o.slide_N, 0.3 * mass * gravity, 1e-9);
    EXPECT_NEAR(o.shake_g, depth / height, 1e-5);
    EXPECT_NEAR(o.push_error_N, foot_off_share * o.push_N, 1e-6);
    // On a smooth floor it slides before it rocks.
    EXPECT_NEAR(overturning(candidate, {}, tipping_of(candidate), 2, 0, {0.1, 0}, floor_m).shake_g,
                0.1, 1e-9);
}

TEST(Overturning, ErrorsAreThoseOfBorderHeightAndMass) {
    const double border = 0.008, high = 0.05, heavy = 2;
    const Candidate candidate = bookcase();
    const Overturning o = overturning(candidate, {heavy, {0, 0, high}}, tipping_of(candidate),
                                      floor_m + height, border, {0.3, 0.1}, floor_m);
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    double tilt = 0, tilt2 = 0, push = 0, push2 = 0, slide = 0, slide2 = 0;
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
        const double s = (0.3 + 0.1 * normal(random)) * m * gravity;
        slide += s / draws;
        slide2 += s * s / draws;
    }
    EXPECT_NEAR(o.tilt_error_deg, std::sqrt(tilt2 - tilt * tilt), 0.06 * o.tilt_error_deg);
    EXPECT_NEAR(o.push_error_N, std::sqrt(push2 - push * push), 0.03 * o.push_error_N);
    EXPECT_NEAR(o.slide_error_N, std::sqrt(slide2 - slide * slide), 0.03 * o.slide_error_N);
}

// A metre above the floor, at the top of what is lower, and at the middle of what is out of reach.
TEST(Overturning, AHandReachesAMetreUp) {
    const Candidate candidate = bookcase();
    const Stability tipping = tipping_of(candidate);
    const auto pushed = [&](double people_on_m) {
        return overturning(candidate, {}, tipping, floor_m + height, 0.01, {0.3, 0}, people_on_m);
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
    const Overturning o =
        overturning(candidate, {}, tipping_of(candidate), 2, 0, {0.3, 0}, floor_m);
    EXPECT_EQ(o.tilt_deg, 0);
    EXPECT_EQ(o.push_N, 0);
    EXPECT_EQ(o.shake_g, 0);
}

TEST(Overturning, WhatHangsOrIsHeldByNothingHasNone) {
    Candidate candidate = bookcase();
    const Stability tipping = tipping_of(candidate);
    candidate.support_height_m = 3;
    EXPECT_TRUE(std::isnan(overturning(candidate, {}, tipping, 2, 0, {0.3, 0}, floor_m).tilt_deg));
    candidate = bookcase();
    candidate.support_polygon.clear();
    EXPECT_TRUE(std::isnan(overturning(candidate, {}, tipping, 2, 0, {0.3, 0}, floor_m).push_N));
}

}  // namespace
}  // namespace topple::physics
