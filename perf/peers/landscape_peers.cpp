// SPDX-License-Identifier: MIT
#include "perf/peers/landscape_peers.h"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <string>

#include "perf/landscape_stages.h"
#include "perf/peers/bullet_pushes.h"
#include "perf/peers/script.h"
#include "physics/hull_landscape.h"

namespace topple::perf {
namespace {

// What was measured of a stage on the first backend that has it.
const Result* first_of(const std::vector<Result>& own, const char* name) {
    const auto at = std::ranges::find(own, name, &Result::name);
    return at == own.end() ? nullptr : &*at;
}

}  // namespace

std::optional<Result> compare_with_trimesh(const std::vector<Result>& own) {
    const Result* mine = first_of(own, "landscapes/hulls");
    if (!mine) return std::nullopt;
    std::ostringstream text;
    text.precision(17);
    for (const auto& hull : hull_points()) {
        for (const Vec3& p : hull) text << p[0] << ' ' << p[1] << ' ' << p[2] << ' ';
        text << '\n';
    }
    const ScriptFile file("hulls.txt");
    file.write(text.str());
    const std::string answer = answer_of("trimesh_poses.py", {&file});
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
    const auto pushes = bullet_pushes(standing_things());
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
