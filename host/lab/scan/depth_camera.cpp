// SPDX-License-Identifier: MIT
#include "lab/scan/depth_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/thread_pool.h"
#include "core/vectors.h"
#include "lab/random.h"
#include "lab/rooms/furnished_room.h"
#include "lab/solids/ray_caster.h"
#include "lab/solids/rigid.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;
constexpr double no_hit = std::numeric_limits<double>::infinity();

Vec3 unit(const Vec3& v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}

double noisy(double z, double cosine, const CameraOptions& o, Random& random) {
    const double angle = std::acos(std::clamp(cosine, 0.0, 1.0));
    if (angle > o.grazing_deg * pi / 180) return 0;
    double sigma = o.axial_m + o.growth * (z - 0.4) * (z - 0.4);
    const double flat = angle / (pi / 2 - angle);
    sigma += 0.0001 * flat * flat / std::sqrt(z);
    return z + sigma * random.normal();
}

// A sensor mixes or loses the readings on both sides of a jump in depth.
void drop_edges(const Intrinsics& k, const std::vector<double>& z,
                std::vector<std::uint16_t>& depth) {
    const auto w = static_cast<std::int64_t>(k.width), h = static_cast<std::int64_t>(k.height);
    for (std::int64_t v = 0; v < h; ++v) {
        for (std::int64_t u = 0; u < w; ++u) {
            const double here = z[v * w + u];
            const double limit = std::max(0.04, 0.06 * here);
            for (const auto& [du, dv] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
                const std::int64_t a = u + du, b = v + dv;
                if (a < 0 || b < 0 || a >= w || b >= h) continue;
                if (!(std::abs(z[b * w + a] - here) < limit)) depth[v * w + u] = 0;
            }
        }
    }
}

// Eye and target of frame n: an ellipse inside the free middle, two rounds, looking outwards in one
// frame and across the room in the next, up and down between knee and eye height.
Mat4 walking_pose(const World& world, const CameraOptions& o, unsigned n, Random& random) {
    const auto middle = free_middle(world);
    const double angle = 4 * pi * n / o.frames;
    const Vec3 eye{world.room[0] / 2 + 0.95 * middle[0] * std::cos(angle),
                   world.room[1] / 2 + 0.95 * middle[1] * std::sin(angle),
                   1.35 + 0.35 * std::sin(2.5 * angle)};
    const double heading = angle + (n % 2 ? pi : 0) + random(-0.5, 0.5);
    const double pitch = random(-0.75, -0.12);
    return look_at(eye, {eye[0] + std::cos(heading), eye[1] + std::sin(heading), eye[2] + pitch});
}

// A place in the free middle that has the most things that stand on others in its view.
Mat4 single_pose(const World& world) {
    Mat4 best{};
    double most = -1;
    for (int n = 0; n < 16; ++n) {
        const double angle = 2 * pi * n / 16;
        const auto middle = free_middle(world);
        const Vec3 eye{world.room[0] / 2 - 0.9 * middle[0] * std::cos(angle),
                       world.room[1] / 2 - 0.9 * middle[1] * std::sin(angle), 1.5};
        const Mat4 pose =
            look_at(eye, {eye[0] + std::cos(angle), eye[1] + std::sin(angle), eye[2] - 0.45});
        double seen = 0;
        for (const auto& [supporter, part] : world.support) {
            const Vec3& c = world.parts[part].center;
            const Vec3 to = unit(minus(c, eye));
            if (to[0] * pose[2] + to[1] * pose[6] + to[2] * pose[10] > 0.88)
                seen += supporter == 0 ? 1 : 2;
        }
        if (seen > most) {
            most = seen;
            best = pose;
        }
    }
    return best;
}

}  // namespace

Mat4 look_at(const Vec3& eye, const Vec3& target) {
    const Vec3 forward = unit(minus(target, eye));
    const Vec3 right = unit(cross(forward, {0, 0, 1}));
    const Vec3 down = cross(forward, right);
    return {right[0], down[0], forward[0], eye[0], right[1], down[1], forward[1], eye[1],
            right[2], down[2], forward[2], eye[2], 0,        0,       0,          1};
}

std::vector<std::int16_t> render(const World& world, const CameraOptions& options,
                                 const Mat4& camera_to_room, std::uint64_t frame_number,
                                 std::vector<std::uint16_t>& depth) {
    const Intrinsics& k = options.intrinsics;
    const RayCaster caster(world.parts);
    const Vec3 eye{camera_to_room[3], camera_to_room[7], camera_to_room[11]};
    const std::size_t pixels = std::size_t{k.width} * k.height;
    std::vector<double> exact(pixels, no_hit);
    std::vector<std::int16_t> part(pixels, -1);
    depth.assign(pixels, 0);
    for (std::size_t at = 0; at < pixels; ++at) {
        Random random(options.seed, frame_number * pixels + at);
        double u = static_cast<double>(at % k.width), v = static_cast<double>(at / k.width);
        if (options.noise) {
            u += std::clamp(options.lateral_px * random.normal(), -1.5, 1.5);
            v += std::clamp(options.lateral_px * random.normal(), -1.5, 1.5);
        }
        const Vec3 of_camera = unit({(u - k.cx) / k.fx, (v - k.cy) / k.fy, 1});
        const Vec3 d = turned(camera_to_room, of_camera);
        const RayCaster::Hit hit = caster.cast(eye, d);
        if (hit.part < 0) continue;
        part[at] = static_cast<std::int16_t>(hit.part);
        double z = hit.distance * of_camera[2];
        exact[at] = z;
        if (options.noise) {
            const Vec3 normal = world.parts[hit.part].normal(along(eye, hit.distance, d));
            z = noisy(z, std::abs(dot(normal, d)), options, random);
        }
        const double stored = std::round(z * k.depth_scale);
        if (z >= options.min_range_m && z <= options.max_range_m && stored < 65535.5)
            depth[at] = static_cast<std::uint16_t>(stored);
    }
    if (options.noise) drop_edges(k, exact, depth);
    for (std::size_t at = 0; at < pixels; ++at) {
        if (depth[at] == 0) part[at] = -1;
    }
    return part;
}

Sequence film(const World& world, const CameraOptions& options, std::span<const Mat4> poses) {
    if (world.parts.size() > 32767) {
        throw Error(ErrorKind::usage, "camera: the scene has more than 32767 parts");
    }
    Sequence sequence;
    sequence.intrinsics = options.intrinsics;
    sequence.frames.resize(poses.size());
    sequence.part.resize(poses.size());
    ThreadPool(options.threads).each(poses.size(), 1, [&](std::size_t n) {
        sequence.part[n] = render(world, options, poses[n], n + 1, sequence.frames[n].depth);
        sequence.frames[n].camera_to_world = product(rigid(world.tilt, {}), poses[n]);
    });
    fuse(options, sequence);
    return sequence;
}

Sequence walk(const World& world, const CameraOptions& options) {
    if (options.frames < 1 || options.frames > 9999)
        throw Error(ErrorKind::usage, "camera: takes 1 to 9999 frames");
    Random random(options.seed, 1);
    std::vector<Mat4> poses;
    for (unsigned n = 0; n < (options.single ? 1 : options.frames); ++n) {
        poses.push_back(options.single ? single_pose(world)
                                       : walking_pose(world, options, n, random));
    }
    return film(world, options, poses);
}

}  // namespace topple::scenes
