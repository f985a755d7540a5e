// SPDX-License-Identifier: MIT
#include "simulation/pushes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <span>

#include "topple/device.h"

// S(W) against blows in a simulator.
namespace topple::simulation {
namespace {

// Mean of their places where values are equal.
std::vector<double> ranks(std::span<const double> values) {
    std::vector<double> rank;
    for (const double v : values) {
        const auto below = std::ranges::count_if(values, [&](double w) { return w < v; });
        const auto equal = std::ranges::count(values, v);
        rank.push_back(static_cast<double>(below) + 0.5 * static_cast<double>(equal - 1));
    }
    return rank;
}

double rank_correlation(std::span<const double> a, std::span<const double> b) {
    const std::vector<double> x = ranks(a), y = ranks(b);
    const double mean = 0.5 * static_cast<double>(a.size() - 1);
    double xy = 0, xx = 0, yy = 0;
    for (std::size_t n = 0; n < x.size(); ++n) {
        xy += (x[n] - mean) * (y[n] - mean);
        xx += (x[n] - mean) * (x[n] - mean);
        yy += (y[n] - mean) * (y[n] - mean);
    }
    return xy / std::sqrt(xx * yy);
}

template <typename Work>
double seconds(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Pushes, LeastEnergiesAndTheirDirectionsAreThoseOfTheSimulator) {
    const std::vector<StandingObject> objects = standing_objects(1, 24);
    const auto device = device::open_device("native");
    std::vector<physics::Instability> own;
    std::optional<StandingScene> scene;
    const double before_s = seconds([&] { scene.emplace(*device, objects); });
    const double own_s = seconds([&] { own = scene->instability(); });
    std::vector<double> energies, blows;
    double blows_s = 0;
    int towards = 0;
    std::printf("%-14s %-5s %9s %9s %9s\n", "", "", "W, J", "blow, J", "its way");
    for (std::size_t n = 0; n < objects.size(); ++n) {
        ASSERT_FALSE(own[n].curve.empty()) << objects[n].name;
        energies.push_back(own[n].curve.front().W_J);
        blows_s += seconds([&] { blows.push_back(weakest_blow_J(objects[n])); });
        const double there = weakest_blow_J(objects[n], own[n].direction);
        towards += there <= 1.25 * blows.back();
        std::printf("%-14s %-5s %9.4f %9.4f %9.4f\n", objects[n].name.c_str(),
                    to_string(own[n].mode), energies.back(), blows.back(), there);
    }
    const double correlation = rank_correlation(energies, blows);
    std::printf(
        "rank correlation %.3f; topple %.4f s (and %.3f s before it), blows %.1f s: %.0f times\n",
        correlation, own_s, before_s, blows_s, blows_s / own_s);
    EXPECT_GE(correlation, 0.9);
    // In the direction that topple says, it takes hardly more than in the weakest of all.
    EXPECT_GE(towards, 21);
}

}  // namespace
}  // namespace topple::simulation
