// SPDX-License-Identifier: MIT
#include "lab/scan/viewpoints.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/vectors.h"
#include "lab/scan/depth_camera.h"
#include "lab/scan/smooth.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;
constexpr double cell = 0.12;       // m, of the map of free places
constexpr double least_gap = 0.22;  // m between a camera and any solid

// The largest connected region of places at one height that are clear of all solids, and ways in
// it.
class FreePlaces {
  public:
    FreePlaces(const World& world, const RayCaster& caster, double height)
        : height_(height),
          columns_(static_cast<int>(std::max(1.0, world.room[0] / cell))),
          rows_(static_cast<int>(std::max(1.0, world.room[1] / cell))),
          region_(static_cast<std::size_t>(columns_ * rows_), -2) {
        for (int k = 0; k < columns_ * rows_; ++k) {
            if (caster.clearance(place(k), least_gap) >= least_gap) region_[index(k)] = -1;
        }
        keep_largest();
        if (places_.empty())
            throw Error(ErrorKind::usage, "scan: there is no free place for a camera in this room");
    }

    const std::vector<int>& places() const { return places_; }
    Vec3 place(int k) const {
        return {(k % columns_ + 0.5) * cell, (k / columns_ + 0.5) * cell, height_};
    }
    int any(Random& random) const {
        return places_[random.integer(0, static_cast<int>(places_.size()) - 1)];
    }

    // A shortest way, both ends included.
    std::vector<int> way(int from, int to) const {
        std::vector<int> back(region_.size(), -1), queue{to};
        back[index(to)] = to;
        for (std::size_t n = 0; n < queue.size() && back[index(from)] < 0; ++n) {
            for (const int next : neighbours(queue[n])) {
                if (region_[index(next)] != 0 || back[index(next)] >= 0) continue;
                back[index(next)] = queue[n];
                queue.push_back(next);
            }
        }
        std::vector<int> path{from};
        while (path.back() != to) path.push_back(back[index(path.back())]);
        return path;
    }

  private:
    static std::size_t index(int k) { return static_cast<std::size_t>(k); }

    std::vector<int> neighbours(int k) const {
        std::vector<int> list;
        if (k % columns_ > 0) list.push_back(k - 1);
        if (k % columns_ < columns_ - 1) list.push_back(k + 1);
        if (k >= columns_) list.push_back(k - columns_);
        if (k < columns_ * (rows_ - 1)) list.push_back(k + columns_);
        return list;
    }

    void keep_largest() {
        int regions = 0, best = -1;
        for (int k = 0; k < columns_ * rows_; ++k) {
            if (region_[index(k)] != -1) continue;
            std::vector<int> queue{k};
            region_[index(k)] = regions;
            for (std::size_t n = 0; n < queue.size(); ++n) {
                for (const int next : neighbours(queue[n])) {
                    if (region_[index(next)] != -1) continue;
                    region_[index(next)] = regions;
                    queue.push_back(next);
                }
            }
            if (queue.size() > places_.size()) {
                places_ = std::move(queue);
                best = regions;
            }
            ++regions;
        }
        std::sort(places_.begin(), places_.end());
        for (int& r : region_) r = r == best ? 0 : -2;
    }

    double height_;
    int columns_, rows_;
    std::vector<int> region_;  // 0: one of the places
    std::vector<int> places_;
};

double distance(const Vec3& a, const Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// The middle of each object but the room.
std::vector<Vec3> middles(const World& world) {
    std::vector<Vec3> sum(world.objects.size());
    std::vector<double> count(world.objects.size());
    for (const Part& part : world.parts) {
        const auto n = static_cast<std::size_t>(part.object);
        for (std::size_t a = 0; a < 3; ++a) sum[n][a] += part.center[a];
        count[n] += 1;
    }
    std::vector<Vec3> out;
    for (std::size_t n = 1; n < sum.size(); ++n) {
        if (count[n] > 0)
            out.push_back({sum[n][0] / count[n], sum[n][1] / count[n], sum[n][2] / count[n]});
    }
    if (out.empty()) out.push_back({world.room[0] / 2, world.room[1] / 2, 0.5});
    return out;
}

// Places to pass, each far from those before.
std::vector<int> stops(const FreePlaces& free, unsigned count, Random& random) {
    std::vector<int> chosen{free.any(random)};
    while (chosen.size() < count) {
        int best = -1;
        double most = -1;
        for (int attempt = 0; attempt < 12; ++attempt) {
            const int k = free.any(random);
            double nearest = 1e9;
            for (const int c : chosen)
                nearest = std::min(nearest, distance(free.place(k), free.place(c)));
            if (nearest > most) {
                most = nearest;
                best = k;
            }
        }
        chosen.push_back(best);
    }
    return chosen;
}

// In an order that makes the walk short: always on to the nearest.
void order(const FreePlaces& free, std::vector<int>& places) {
    for (std::size_t n = 1; n < places.size(); ++n) {
        const Vec3 here = free.place(places[n - 1]);
        const auto from = places.begin() + static_cast<std::ptrdiff_t>(n);
        std::iter_swap(from, std::min_element(from, places.end(), [&](int a, int b) {
                           return distance(free.place(a), here) < distance(free.place(b), here);
                       }));
    }
}

Mat4 rolled(const Mat4& pose, double roll) {
    const double c = std::cos(roll), s = std::sin(roll);
    Mat4 out = pose;
    for (std::size_t row = 0; row < 3; ++row) {
        out[4 * row] = c * pose[4 * row] + s * pose[4 * row + 1];
        out[4 * row + 1] = c * pose[4 * row + 1] - s * pose[4 * row];
    }
    return out;
}

// How many different things are seen well, by a few rays.
double things_in_view(const World& world, const RayCaster& caster, const Mat4& pose) {
    std::map<std::int32_t, int> seen;
    constexpr int wide = 32, high = 24;
    for (int v = 0; v < high; ++v) {
        for (int u = 0; u < wide; ++u) {
            const double x = (u + 0.5 - wide / 2.0) / wide * 1.12,
                         y = (v + 0.5 - high / 2.0) / wide * 1.12;
            const double length = std::hypot(x, y, 1.0);
            Vec3 d{};
            for (std::size_t a = 0; a < 3; ++a)
                d[a] = (pose[4 * a] * x + pose[4 * a + 1] * y + pose[4 * a + 2]) / length;
            const auto hit = caster.cast({pose[3], pose[7], pose[11]}, d);
            if (hit.part >= 0 && hit.distance < 4) ++seen[world.parts[hit.part].object];
        }
    }
    double score = 0;
    for (const auto& [object, rays] : seen) {
        if (object != 0) score += std::min(1.0, rays / 12.0);
    }
    return score;
}

}  // namespace

std::vector<Vec3> scanner_stations(const World& world, const RayCaster& caster, unsigned count,
                                   double height, Random& random) {
    const FreePlaces free(world, caster, height);
    std::vector<Vec3> out;
    for (const int k : stops(free, count, random)) out.push_back(free.place(k));
    return out;
}

std::vector<Mat4> hand_held_walk(const World& world, const RayCaster& caster, unsigned frames,
                                 Random& random) {
    const double height = random(1.3, 1.6);
    const FreePlaces free(world, caster, height);
    auto passed = stops(free, std::clamp(frames / 6, 3u, 24u), random);
    order(free, passed);
    // The way through them, and what is looked at from each: near things, each seldom twice.
    std::vector<Vec3> way, gaze;
    std::vector<double> seen;
    const auto things = middles(world);
    seen.assign(things.size(), 0);
    for (std::size_t n = 0; n < passed.size(); ++n) {
        const Vec3 here = free.place(passed[n]);
        std::size_t best = 0;
        double least = 1e9;
        for (std::size_t k = 0; k < things.size(); ++k) {
            const double d = distance(things[k], here);
            const double cost = std::abs(d - 1.7) + 1.5 * seen[k] + random(0, 2);
            if (cost < least) {
                least = cost;
                best = k;
            }
        }
        for (std::size_t k = 0; k < things.size(); ++k) {
            if (distance(things[k], things[best]) < 0.7) seen[k] += 1;
        }
        Vec3 at = things[best];
        at[2] = std::clamp(at[2], 0.15, height + 0.5);
        const auto path = n == 0 ? std::vector<int>{passed[0]} : free.way(passed[n - 1], passed[n]);
        for (std::size_t k = n == 0 ? 0 : 1; k < path.size(); ++k) {
            way.push_back(free.place(path[k]));
            const double share =
                n == 0 ? 1 : static_cast<double>(k) / static_cast<double>(path.size() - 1);
            const Vec3 before = n == 0 ? at : gaze[gaze.size() - (k > 0 ? k : 1)];
            gaze.push_back(along(before, std::min(1.0, 1.4 * share), minus(at, before)));
        }
    }
    const auto sway = [&](double size) { return smooth_noise(frames, 2.5, size, random); };
    const auto sx = sway(0.03), sy = sway(0.03), sz = sway(0.08), yaw = sway(0.12),
               pitch = sway(0.1), roll = sway(0.04);
    std::vector<Mat4> poses;
    for (unsigned n = 0; n < frames; ++n) {
        const double s =
            static_cast<double>(n) * static_cast<double>(way.size() - 1) / std::max(1u, frames - 1);
        const auto k = static_cast<std::size_t>(s);
        const std::size_t next = std::min(k + 1, way.size() - 1);
        const double f = s - static_cast<double>(k);
        Vec3 eye = along(way[k], f, minus(way[next], way[k]));
        const Vec3 at = along(gaze[k], f, minus(gaze[next], gaze[k]));
        eye = {eye[0] + sx[n], eye[1] + sy[n], eye[2] + sz[n]};
        const double flat = std::max(0.3, std::hypot(at[0] - eye[0], at[1] - eye[1]));
        const double heading = std::atan2(at[1] - eye[1], at[0] - eye[0]) + yaw[n];
        const double down = std::clamp(std::atan2(at[2] - eye[2], flat) + pitch[n], -1.1, 0.45);
        poses.push_back(rolled(look_at(eye, {eye[0] + std::cos(heading), eye[1] + std::sin(heading),
                                             eye[2] + std::tan(down)}),
                               roll[n]));
    }
    return poses;
}

Mat4 best_view(const World& world, const RayCaster& caster, Random& random) {
    const auto things = middles(world);
    Mat4 best{};
    double most = -1;
    for (int attempt = 0; attempt < 24; ++attempt) {
        const FreePlaces free(world, caster, random(1.0, 1.7));
        for (int k = 0; k < 6; ++k) {
            const Vec3 eye = free.place(free.any(random));
            const auto n = random.integer(0, static_cast<int>(things.size()) - 1);
            Vec3 at = things[n];
            const double d = distance(at, eye);
            if (d < 0.6 || d > 3.0 || at[2] > eye[2] + 0.3) continue;
            if (std::hypot(at[0] - eye[0], at[1] - eye[1]) < 0.2) continue;
            const Mat4 pose = rolled(look_at(eye, at), random(-0.05, 0.05));
            const double score = things_in_view(world, caster, pose);
            if (score > most) {
                most = score;
                best = pose;
            }
        }
    }
    if (most < 0) throw Error(ErrorKind::usage, "scan: no view of this room shows a thing");
    return best;
}

}  // namespace topple::scenes
