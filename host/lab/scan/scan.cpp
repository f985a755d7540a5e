// SPDX-License-Identifier: MIT
#include "lab/scan/scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/short_number.h"
#include "core/thread_pool.h"
#include "core/vectors.h"
#include "lab/scan/smooth.h"
#include "lab/scan/viewpoints.h"
#include "lab/solids/rigid.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

// A few degrees of tilt, any heading and origin.
Mat4 any_frame(const World& world, Random& random) {
    const double heading = random(0, 2 * pi), lean = random(0, 4) * pi / 180;
    const double yaw = random.chance(0.25) ? 0 : random(-pi, pi);
    const auto tilt = rotation({std::cos(heading), std::sin(heading), 0}, lean);
    Mat4 m = product(rigid(tilt, {}), rigid(rotation({0, 0, 1}, yaw), {}));
    const Vec3 middle =
        moved(m, {random.uniform() * world.room[0], random.uniform() * world.room[1], 0});
    m[3] = -middle[0];
    m[7] = -middle[1];
    m[11] = random(-1.5, 0.5) - middle[2];
    return m;
}

Light any_light(Random& random) {
    const double heading = random(0, 2 * pi), height = random(0.6, 0.95);
    const double flat = std::sqrt(1 - height * height);
    return {{flat * std::cos(heading), flat * std::sin(heading), height},
            random(0.4, 0.7),
            random(3, 9),
            random(0.8, 1.1)};
}

struct Shot {
    ExactView view;
    std::vector<float> depth;
};

class Scanner {
  public:
    Scanner(const World& world, const ScanOptions& options)
        : world_(world),
          options_(options),
          random_(options.seed, 77),
          caster_(world.parts),
          light_(any_light(random_)) {
        scan_.world_to_scan = any_frame(world, random_);
    }

    Scan take() {
        switch (options_.kind) {
            case ScanKind::walk:
                walk();
                break;
            case ScanKind::single:
                single();
                break;
            case ScanKind::laser:
                laser();
                break;
            default:
                fuse();
        }
        if (!scan_.cloud.empty()) crop();
        for (LabelledPoint& p : seen_) p.at = moved(scan_.world_to_scan, p.at);
        scan_.truth = std::move(seen_);
        return std::move(scan_);
    }

  private:
    unsigned frame_count(double per_m2, unsigned least, unsigned most) const {
        if (options_.frames > 0) return options_.frames;
        const double wanted = least + per_m2 * world_.room[0] * world_.room[1];
        return static_cast<unsigned>(std::min(wanted, static_cast<double>(most)));
    }

    // Renders all poses and hands them on in their order.
    template <class Use>
    void shoot(const std::vector<Mat4>& poses, const Intrinsics& k, const Sensor& sensor,
               const Use& use) {
        constexpr std::size_t batch = 16;
        ThreadPool threads(options_.threads);
        for (std::size_t first = 0; first < poses.size(); first += batch) {
            const std::size_t last = std::min(first + batch, poses.size());
            std::vector<Shot> shots(last - first);
            threads.each(last - first, 1, [&](std::size_t at) {
                Shot& shot = shots[at];
                const std::size_t n = first + at;
                Light light = light_;
                light.exposure *= Random(options_.seed, 9000 + n)(0.93, 1.07);
                shot.view = look(caster_, k, poses[n], light, Random(options_.seed, 10000 + 2 * n));
                shot.depth =
                    rough_depth(shot.view, k, sensor, Random(options_.seed, 10001 + 2 * n));
            });
            for (std::size_t n = first; n < last; ++n) {
                note_truth(shots[n - first].view, k, poses[n], sensor);
                use(n, shots[n - first]);
            }
        }
    }

    void note_truth(const ExactView& view, const Intrinsics& k, const Mat4& pose,
                    const Sensor& sensor) {
        std::vector<LabelledPoint> points;
        for (std::size_t at = 0; at < view.depth.size(); ++at) {
            const double z = view.depth[at];
            if (!(z > sensor.least_m && z < sensor.most_m) || view.cosine[at] < 0.12) continue;
            const auto part = static_cast<std::size_t>(view.part[at]);
            points.push_back({moved(pose, place_of(k, at, z)), world_.parts[part].object});
        }
        note(points);
    }
    void note(const std::vector<LabelledPoint>& points) {
        const auto few = thinned(points, scan_.truth_m, scan_.building_truth_m);
        seen_.insert(seen_.end(), few.begin(), few.end());
        if (seen_.size() < 2 * kept_ + 500000) return;
        thin();
    }
    void thin() {
        seen_ = thinned(seen_, scan_.truth_m, scan_.building_truth_m);
        kept_ = seen_.size();
    }

    // What SLAM gets wrong: millimetres and tenths of a degree, slowly changing; sometimes
    // centimetres.
    std::vector<Mat4> drifted(const std::vector<Mat4>& poses) {
        const std::size_t n = poses.size();
        const double worse = random_.chance(0.3) ? 3 : 1;
        const double off = worse * random_(0.001, 0.005), turn = worse * random_(0.0005, 0.0025);
        std::vector<std::vector<double>> noise;
        for (int a = 0; a < 6; ++a)
            noise.push_back(smooth_noise(n, 4, a < 3 ? off : turn, random_));
        std::vector<Mat4> out;
        for (std::size_t k = 0; k < n; ++k) {
            Mat4 m = poses[k];
            const Vec3 t{m[3] + noise[0][k], m[7] + noise[1][k], m[11] + noise[2][k]};
            const Vec3 axis{noise[3][k], noise[4][k], noise[5][k]};
            const double angle = std::max(1e-12, std::hypot(axis[0], axis[1], axis[2]));
            const auto r = rotation({axis[0] / angle, axis[1] / angle, axis[2] / angle}, angle);
            m[3] = m[7] = m[11] = 0;
            m = product(rigid(r, {}), m);
            m[3] = t[0];
            m[7] = t[1];
            m[11] = t[2];
            out.push_back(m);
        }
        return out;
    }

    void keep_frame(const Mat4& pose, Shot& shot) {
        DepthFrame frame;
        frame.camera_to_world = pose;
        for (const float z : shot.depth) {
            const double stored = std::round(z * scan_.intrinsics.depth_scale);
            frame.depth.push_back(static_cast<std::uint16_t>(std::min(stored, 65535.0)));
        }
        scan_.frames.push_back(std::move(frame));
        scan_.colour.push_back(std::move(shot.view.colour));
    }

    void walk() {
        const double focal = random_(262, 300);
        scan_.intrinsics = {320, 240, focal, focal, 159.5, 119.5, 1000};
        scan_.truth_m = 0.015;
        const Sensor sensor = any_sensor(scan_.intrinsics, random_);
        const auto poses = hand_held_walk(world_, caster_, frame_count(1.5, 40, 90), random_);
        const auto told = drifted(poses);
        shoot(poses, scan_.intrinsics, sensor, [&](std::size_t n, Shot& shot) {
            keep_frame(product(scan_.world_to_scan, told[n]), shot);
        });
        thin();
    }

    void single() {
        const bool large = random_.chance(0.5);
        const double focal = random_(0.82, 0.95);
        const unsigned w = large ? 640 : 320, h = large ? 480 : 240;
        scan_.intrinsics = {w, h, w * focal, w * focal, w / 2 - 0.5, h / 2 - 0.5, 1000};
        const Mat4 pose = best_view(world_, caster_, random_);
        scan_.world_to_scan = inverse(pose);
        shoot({pose}, scan_.intrinsics, any_sensor(scan_.intrinsics, random_),
              [&](std::size_t, Shot& shot) { keep_frame(identity, shot); });
        thin();
    }

    void fuse() {
        const bool sparse = options_.kind == ScanKind::sparse;
        const double spacing = options_.spacing_m > 0 ? options_.spacing_m
                               : sparse               ? random_(0.02, 0.06)
                                                      : random_(0.008, 0.02);
        const Intrinsics k = sparse ? Intrinsics{192, 144, 164, 164, 95.5, 71.5, 1000}
                                    : Intrinsics{320, 240, 277, 277, 159.5, 119.5, 1000};
        scan_.truth_m = 0.015;
        const Sensor sensor = any_sensor(k, random_);
        const auto poses = hand_held_walk(world_, caster_, frame_count(2.5, 60, 130), random_);
        const auto told = drifted(poses);
        std::vector<ColouredPoint> all;
        const double fine = std::min(0.015, 0.5 * spacing);
        shoot(poses, k, sensor, [&](std::size_t n, Shot& shot) {
            const Mat4 to_scan = product(scan_.world_to_scan, told[n]);
            for (std::size_t at = 0; at < shot.depth.size(); ++at) {
                const double z = shot.depth[at];
                if (z == 0) continue;
                all.push_back({moved(to_scan, place_of(k, at, z)), shot.view.colour[at]});
            }
        });
        thin();
        const auto base = fused(all, sparse ? fine : 0.6 * spacing, sparse ? 2 : 1);
        // Spaced evenly, or drawn by lot from what lay closer, as by those who thin a mesh to so
        // many of its corners.
        if (sparse && random_.chance(0.5)) {
            constexpr double kept = 0.3;
            scan_.cloud = fused(all, spacing * std::sqrt(kept), 1);
            std::erase_if(scan_.cloud, [&](const auto&) { return !random_.chance(kept); });
        } else {
            scan_.cloud = fused(all, spacing, 2);
        }
        if (sparse || random_.chance(0.5)) {
            const double radius = sparse ? random_(0.012, 0.035) : 1.2 * spacing;
            smooth_among(scan_.cloud, base, radius, random_(0.3, 0.8));
        }
        const double area = world_.room[0] * world_.room[1];
        tear_holes(scan_.cloud, static_cast<unsigned>(random_(0.3, 2.5) * area), 0.04, 0.18,
                   random_);
        const double jitter = sparse ? random_(0, 0.003) : 0;
        for (ColouredPoint& p : scan_.cloud) {
            for (double& a : p.at) a += jitter * random_.normal();
        }
    }

    void laser() {
        const auto count = static_cast<unsigned>(random_.integer(1, 4));
        const double height = random_(1.3, 1.7);
        const double step =
            (options_.spacing_m > 0 ? options_.spacing_m / 3 : random_(0.3, 0.7) * pi / 180);
        scan_.truth_m = 0.012;
        for (const Vec3& eye : scanner_stations(world_, caster_, count, height, random_))
            sweep(eye, step, random_(0.001, 0.005));
        thin();
    }

    // Many cut the ceiling off their clouds to look in, and with it the tops of walls and cabinets.
    void crop() {
        Random random(options_.seed, 78 + static_cast<std::uint64_t>(options_.kind));
        if (!random.chance(0.35)) return;
        const double height = random(1.5, 2.4);
        const Mat4 to_room = inverse(scan_.world_to_scan);
        std::erase_if(scan_.cloud,
                      [&](const ColouredPoint& p) { return moved(to_room, p.at)[2] > height; });
        std::erase_if(seen_, [&](const LabelledPoint& p) { return p.at[2] > height; });
    }

    // One station: column by column from below upwards.
    void sweep(const Vec3& eye, double step, double noise) {
        const double drop = random_(0.002, 0.03), mixed = random_(0.1, 0.4);
        const double first = random_(0, 2 * pi);
        std::vector<LabelledPoint> points;
        for (double azimuth = 0; azimuth < 2 * pi; azimuth += step) {
            double before = 0;
            for (double up = -60 * pi / 180; up < 80 * pi / 180; up += step) {
                const Vec3 d{std::cos(first + azimuth) * std::cos(up),
                             std::sin(first + azimuth) * std::cos(up), std::sin(up)};
                const auto hit = caster_.cast(eye, d);
                const double last = std::exchange(before, hit.part < 0 ? 0 : hit.distance);
                if (hit.part < 0 || hit.distance < 0.4 || hit.distance > 25) continue;
                const Part& part = world_.parts[hit.part];
                const Vec3 p = along(eye, hit.distance, d), normal = part.normal(p);
                points.push_back({p, part.object});
                const double cosine = std::abs(dot(normal, d));
                if (random_.chance(drop) || random_.chance((0.12 - cosine) / 0.1)) continue;
                double t = hit.distance + noise * random_.normal();
                if (last > 0.4 && std::abs(last - hit.distance) > 0.05 && random_.chance(mixed))
                    t += random_.uniform() * (last - hit.distance);
                scan_.cloud.push_back({moved(scan_.world_to_scan, along(eye, t, d)),
                                       light_.shade(part, normal, p, random_)});
            }
        }
        note(points);
    }

    const World& world_;
    const ScanOptions& options_;
    Random random_;
    RayCaster caster_;
    Light light_;
    Scan scan_;
    std::vector<LabelledPoint> seen_;  // room frame
    std::size_t kept_ = 0;
};

}  // namespace

Scan scan(const World& world, const ScanOptions& options) {
    if (options.frames > 10000)
        throw Error(ErrorKind::usage,
                    "--frames " + std::to_string(options.frames) + ": expected 1 to 10000");
    if (options.spacing_m != 0 && !(options.spacing_m >= 0.002 && options.spacing_m <= 0.5))
        throw Error(ErrorKind::usage,
                    "--spacing " + short_number(options.spacing_m) + ": expected 0.002 to 0.5 m");
    return Scanner(world, options).take();
}

const char* to_string(ScanKind kind) {
    constexpr std::array names{"walk", "sparse", "cloud", "laser", "single"};
    return names[static_cast<std::size_t>(kind)];
}

}  // namespace topple::scenes
