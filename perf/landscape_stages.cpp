// SPDX-License-Identifier: MIT
#include "perf/landscape_stages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/thread_pool.h"
#include "lab/random.h"
#include "physics/hull_landscape.h"
#include "physics/landscape.h"

namespace topple::perf {
namespace {

constexpr std::size_t hulls = 100, points = 50;

// Points on an ellipsoid of random half axes.
std::vector<Vec3> shell(scenes::Random& random, std::size_t count, const Vec3& center) {
    Vec3 half{};
    for (double& h : half) h = random(0.05, 0.3);
    std::vector<Vec3> out;
    while (out.size() < count) {
        Vec3 p{};
        double length2 = 0;
        for (double& x : p) {
            x = random.normal();
            length2 += x * x;
        }
        for (std::size_t a = 0; a < 3; ++a) p[a] = center[a] + half[a] * p[a] / std::sqrt(length2);
        out.push_back(p);
    }
    return out;
}

Hash& add(Hash& hash, double value) {
    return hash.word(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

Result measure_hulls(device::Device& device, unsigned runs) {
    const auto all = hull_points();
    Result result = named(device, "landscapes/hulls", {hulls, "hulls", 0, 0});
    std::vector<physics::HullLandscape> landscapes(all.size());
    sample(device, result, runs, [&] {
        device.threads().each(all.size(), 1, [&](std::size_t n) {
            landscapes[n] = physics::hull_landscape(all[n], {0, 0, 0});
        });
    });
    Hash hash;
    for (const auto& landscape : landscapes) {
        for (const auto& pose : landscape.poses) add(hash, pose.barrier_m);
    }
    result.hash = hash.value();
    return result;
}

Result measure_objects(device::Device& device, unsigned runs) {
    const auto objects = standing_things();
    const simulation::StandingScene scene(device, objects);
    Result result =
        named(device, "landscapes/objects", {static_cast<double>(objects.size()), "objects", 0, 0});
    std::vector<physics::Instability> instability;
    sample(device, result, runs, [&] { instability = scene.instability(); });
    Hash hash;
    for (const physics::Instability& i : instability) add(hash, i.barrier_J);
    result.hash = hash.value();
    return result;
}

}  // namespace

std::vector<std::vector<Vec3>> hull_points() {
    scenes::Random random(2);
    std::vector<std::vector<Vec3>> all;
    for (std::size_t n = 0; n < hulls; ++n) all.push_back(shell(random, points, {0, 0, 0}));
    return all;
}

std::vector<simulation::StandingObject> standing_things() {
    return simulation::standing_objects(1, 24);
}

std::vector<std::string> landscape_names() {
    return {"landscapes/hulls", "landscapes/objects"};
}

std::vector<Result> measure_landscapes(device::Device& device, unsigned runs) {
    return {measure_hulls(device, runs), measure_objects(device, runs)};
}

}  // namespace topple::perf
