// SPDX-License-Identifier: MIT
#include "perf/landscape_stages.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "perf/peers/bullet_pushes.h"
#include "physics/hull_landscape.h"
#include "physics/landscape.h"
#include "scenes/random.h"
#include "simulation/pushes.h"
#include "topple/error.h"

namespace topple::perf {
namespace {

constexpr std::size_t primitives = 96, vertices = 128, groups = 1000, hulls = 100, points = 50;

// Points on an ellipsoid of random half axes.
std::vector<Vec3> shell(scenes::Random& random, std::size_t count, const Vec3& center) {
    Vec3 half{};
    for (double& h : half) h = random.uniform(0.05, 0.3);
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

std::vector<std::vector<Vec3>> hull_points() {
    scenes::Random random(2);
    std::vector<std::vector<Vec3>> all;
    for (std::size_t n = 0; n < hulls; ++n) all.push_back(shell(random, points, {0, 0, 0}));
    return all;
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
            for (std::size_t a = 0; a < 3; ++a)
                mean[a] += center[static_cast<std::size_t>(m)][a] / members;
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
    Hash hash;
    sample(device, result, runs, [&] {
        hash = Hash();
        for (const auto& hull : all) {
            for (const auto& pose : physics::hull_landscape(hull, {0, 0, 0}).poses)
                add(hash, pose.barrier_m);
        }
    });
    result.hash = hash.value();
    return result;
}

std::vector<simulation::StandingObject> standing_objects() {
    return simulation::standing_objects(1, 24);
}

Result measure_objects(device::Device& device, unsigned runs) {
    const auto objects = standing_objects();
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

// What was measured of a stage on the first backend that has it.
const Result* first_of(const std::vector<Result>& own, const char* name) {
    const auto at = std::ranges::find(own, name, &Result::name);
    return at == own.end() ? nullptr : &*at;
}

}  // namespace

std::vector<std::string> landscape_names() {
    return {"landscapes/table", "landscapes/groups", "landscapes/hulls", "landscapes/objects"};
}

std::vector<Result> measure_landscapes(device::Device& device, unsigned runs) {
    const physics::SphereMesh mesh = physics::geodesic_sphere(16);
    scenes::Random random(1);
    std::vector<Vec3> center;
    std::vector<std::vector<Vec3>> sets;
    for (std::size_t p = 0; p < primitives; ++p) {
        center.push_back(
            {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(0, 1)});
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

std::optional<Result> compare_with_trimesh(const std::vector<Result>& own) {
    const Result* mine = first_of(own, "landscapes/hulls");
    if (!mine) return std::nullopt;
    const auto path = std::filesystem::temp_directory_path() /
                      ("topple-hulls-" + std::to_string(getpid()) + ".txt");
    std::ofstream file(path);
    file.precision(17);
    for (const auto& hull : hull_points()) {
        for (const Vec3& p : hull) file << p[0] << ' ' << p[1] << ' ' << p[2] << ' ';
        file << '\n';
    }
    file.close();
    if (!file) throw Error(ErrorKind::input, path.string() + ": can't be written");
    const std::string command =
        "python3 " TOPPLE_PERF_DIR "/peers/trimesh_poses.py '" + path.string() + "'";
    std::string answer;
    if (std::FILE* pipe = popen(command.c_str(), "r")) {
        char text[256];
        while (std::fgets(text, sizeof(text), pipe)) answer += text;
        pclose(pipe);
    }
    std::filesystem::remove(path);
    Result peer;
    std::istringstream words(answer);
    std::string version;
    double seconds = 0, poses = 0;
    if (!(words >> version >> seconds >> poses)) {
        std::printf("trimesh: not found by python3; it is on PyPI, with scipy and networkx\n");
        return std::nullopt;
    }
    peer.backend = "peer";
    peer.device = "trimesh " + version;
    peer.name = "landscapes/hulls/trimesh";
    peer.work = mine->work;
    peer.samples_s = {seconds};
    std::size_t own_poses = 0;
    for (const auto& hull : hull_points())
        own_poses += physics::hull_landscape(hull, {0, 0, 0}).poses.size();
    std::printf("%-32s %9.4f %9.3f %8.1fx  %zu poses against %.0f\n", peer.name.c_str(),
                mine->best(), seconds, seconds / mine->best(), own_poses, poses);
    return peer;
}

std::optional<Result> compare_with_bullet(const std::vector<Result>& own) {
    const Result* mine = first_of(own, "landscapes/objects");
    if (!mine) return std::nullopt;
    const auto pushes = bullet_pushes(standing_objects());
    if (!pushes) {
        std::printf("Bullet: not in this build; apt-get install libbullet-dev\n");
        return std::nullopt;
    }
    Result peer;
    peer.backend = "peer";
    peer.device = pushes->library;
    peer.name = "landscapes/objects/bullet";
    peer.work = mine->work;
    peer.samples_s = {pushes->seconds};
    std::printf("%-32s %9.4f %9.3f %8.1fx\n", peer.name.c_str(), mine->best(), pushes->seconds,
                pushes->seconds / mine->best());
    return peer;
}

}  // namespace topple::perf
