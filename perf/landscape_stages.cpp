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

constexpr std::size_t primitives = 96, vertices = 128, groups = 1000, hulls = 100, points = 50;

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

// Groups that stand on a square as wide as they are: 20 cm.
std::vector<physics::Candidate> group_candidates(const std::vector<Vec3>& center) {
    scenes::Random random(3);
    std::vector<physics::Candidate> all;
    for (std::size_t n = 0; n < groups; ++n) {
        physics::Candidate candidate;
        const int members = random.integer(1, 8);
        const int first = random.integer(0, static_cast<int>(primitives) - members);
        Vec3 mean{};
        for (int m = first; m < first + members; ++m) {
            candidate.primitives.push_back(m);
            for (std::size_t a = 0; a < 3; ++a) mean[a] += center[m][a] / members;
        }
        candidate.body = {1, 0.01, 7, mean};
        for (const auto& [x, y] : {std::array{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}})
            candidate.support_polygon.push_back({mean[0] + x, mean[1] + y});
        candidate.support_height_m = mean[2] - 0.3;
        all.push_back(std::move(candidate));
    }
    return all;
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
    return {"landscapes/table", "landscapes/groups", "landscapes/hulls", "landscapes/objects"};
}

std::vector<Result> measure_landscapes(device::Device& device, unsigned runs) {
    const physics::SphereMesh mesh = physics::geodesic_sphere(16);
    scenes::Random random(1);
    std::vector<Vec3> center;
    std::vector<std::vector<Vec3>> sets;
    for (std::size_t p = 0; p < primitives; ++p) {
        center.push_back({random(-0.5, 0.5), random(-0.5, 0.5), random(0, 1)});
        sets.push_back(shell(random, vertices, center.back()));
    }
    const double directions = static_cast<double>(mesh.size());
    std::vector<Result> results;
    std::unique_ptr<physics::SupportTable> table;
    results.push_back(named(device, "landscapes/table",
                            {primitives * vertices * directions, "dot products", 0, 0}));
    sample(device, results.back(), runs,
           [&] { table = std::make_unique<physics::SupportTable>(device, sets, 0.01, mesh); });
    results.push_back(
        named(device, "landscapes/groups", {groups * directions, "directions", 0, 0}));
    const auto candidates = group_candidates(center);
    std::vector<physics::Stability> stability;
    sample(device, results.back(), runs,
           [&] { stability = physics::evaluate(device, *table, candidates); });
    Hash hash;
    for (const physics::Stability& s : stability) add(hash, s.barrier_J);
    results.back().hash = hash.value();
    results.push_back(measure_hulls(device, runs));
    results.push_back(measure_objects(device, runs));
    return results;
}

}  // namespace topple::perf
