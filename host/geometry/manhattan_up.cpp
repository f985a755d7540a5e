// SPDX-License-Identifier: MIT
#include "geometry/manhattan_up.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace topple::geometry {
namespace {

// Surface within this angle of a direction can lie in a plane across it.
constexpr double plane_degrees = 10;
// A camera's up and the scene's differ by the camera's pitch, which passes this only when it looks
// nearly straight down.
constexpr double most_pitch_degrees = 75;
// The dominant plane must hold this share of the surface to decide on up.
constexpr double least_plane_share = 0.05;

// The surface across one direction, by where it lies along it.
struct Profile {
    double share = 0;   // in large planes, of all surface
    double facing = 0;  // -1..1: which way the surface in large planes faces, on the whole
    // -1..1: how far the middle of the surface between the outermost tenths lies below half height.
    double lowness = 0;
    double extent = 0;  // of the scene along the direction, metres, without the outer 1 %
};

Profile profile(const Surfels& s, const WeightedNormals& normals, const Vec3& axis) {
    Profile result;
    const double least = std::cos(plane_degrees * std::numbers::pi / 180);
    // Three cells: a plane that is off by 10 degrees over a small table still falls in few bins.
    const double bin = 3 * s.cell_m;
    std::vector<double> height(normals.size());
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const std::uint32_t k = normals.surfel[i];
        height[i] = s.x[k] * axis[0] + s.y[k] * axis[1] + s.z[k] * axis[2];
    }
    std::vector<double> sorted = height;
    std::sort(sorted.begin(), sorted.end());
    const double low = sorted.front(), bottom = sorted[sorted.size() / 100],
                 top = sorted[sorted.size() - 1 - sorted.size() / 100];
    result.extent = top - bottom;
    const auto bins = static_cast<std::size_t>((sorted.back() - low) / bin) + 1;
    std::vector<double> weight(bins + 1), facing(bins + 1);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const double d = normals.x[i] * axis[0] + normals.y[i] * axis[1] + normals.z[i] * axis[2];
        if (std::abs(d) < least) continue;
        const auto b = static_cast<std::size_t>((height[i] - low) / bin);
        weight[b] += normals.weight[i];
        facing[b] += d < 0 ? -normals.weight[i] : normals.weight[i];
    }
    // Large: two neighbouring bins hold at least a hundredth of the surface.
    double faced = 0, flat = 0;
    for (std::size_t b = 0; b < bins; ++b) {
        const double pair = weight[b] + weight[b + 1],
                     before = b > 0 ? weight[b - 1] + weight[b] : 0;
        if (std::max(pair, before) >= 0.01 * normals.total) {
            flat += weight[b];
            faced += facing[b];
        }
    }
    result.share = flat / normals.total;
    result.facing = flat > 0 ? faced / flat : 0;
    double sum = 0, rest = 0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (height[i] < bottom + 0.1 * result.extent || height[i] > top - 0.1 * result.extent)
            continue;
        sum += normals.weight[i] * ((bottom + top) / 2 - height[i]);
        rest += normals.weight[i];
    }
    if (rest > 0 && result.extent > 0) result.lowness = sum / rest / (0.4 * result.extent);
    return result;
}

// Which way along the axis is up, without a camera: +1 or -1. Large planes face up more than down
// (ceilings and undersides are seen less), and what stands in the scene stands on its lower side.
double side(const Profile& p, const Vec3& axis) {
    // The input's z breaks what the scene leaves open.
    const double convention = std::abs(axis[2]) > 0.9 ? (axis[2] > 0 ? 1.0 : -1.0) : 0;
    return p.facing + 2 * p.lowness + convention < 0 ? -1 : 1;
}

Vec3 times(const Vec3& v, double factor) {
    return {v[0] * factor, v[1] * factor, v[2] * factor};
}

}  // namespace

UpChoice choose_up(const Surfels& surfels, const WeightedNormals& normals,
                   const std::vector<Vec3>& directions, const std::vector<Vec3>& manhattan,
                   const FrameHints& hints) {
    if (hints.up && dot(*hints.up, *hints.up) > 0) return {unit(*hints.up), "given"};
    const bool camera = hints.camera_up && dot(*hints.camera_up, *hints.camera_up) > 0;
    const Vec3 hint = camera ? unit(*hints.camera_up) : Vec3{0, 0, 1};
    const UpChoice assumed{hint, "assumed"};
    if (normals.size() == 0) return assumed;

    std::vector<Vec3> candidates = manhattan;
    candidates.insert(candidates.end(), directions.begin(), directions.end());
    double best_score = 0;
    Vec3 best{};
    Profile best_profile;
    bool in_manhattan = false;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const Profile p = profile(surfels, normals, candidates[i]);
        if (p.share < least_plane_share) continue;
        const double along = std::abs(dot(candidates[i], hint));
        double score = p.share;
        if (camera) {
            if (along < std::cos(most_pitch_degrees * std::numbers::pi / 180)) continue;
            score *= along * along;
        } else {
            score /= std::max(p.extent, 10 * surfels.cell_m);
            score *= along > 0.9 ? 2 : 1;
        }
        // An axis of the best triple goes before a single direction that is no better.
        if (i < manhattan.size()) score *= 1.1;
        if (score > best_score) {
            best_score = score;
            best = candidates[i];
            best_profile = p;
            in_manhattan = i < manhattan.size();
        }
    }
    if (best_score == 0) return assumed;
    const double sign = camera ? (dot(best, hint) < 0 ? -1 : 1) : side(best_profile, best);
    return {refine_axis(normals, times(best, sign)), in_manhattan ? "manhattan" : "dominant-plane"};
}

}  // namespace topple::geometry
