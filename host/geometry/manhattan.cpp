// SPDX-License-Identifier: MIT
#include "geometry/manhattan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/fourfold.h"
#include "geometry/manhattan_normals.h"
#include "geometry/manhattan_up.h"

namespace topple::geometry {
namespace {

// Clusters to look for: K > 3 (paper, 2.2.1). More than the scene has surfaces' directions does no
// harm.
constexpr unsigned cluster_count = 12;
// Enough normals to find an axis to a hundredth of a degree.
constexpr std::size_t most_normals = 60'000;
// Directions spread evenly over the sphere leave 1 - cos(10 degrees) = 1.5 % near each axis. An
// axis of the scene must hold twice that, and all three a quarter of the surface.
constexpr double least_axis_share = 0.03, least_total_share = 0.25;

struct Triple {
    std::array<Vec3, 3> axes{};
    std::array<double, 3> share{};
    double total = 0;
};

// The orthonormal axes nearest to three near-orthogonal ones: alternate averaging with the cross
// products of the others, which converges to the polar factor for small deviations.
std::array<Vec3, 3> orthogonalise(std::array<Vec3, 3> a) {
    for (int round = 0; round < 20; ++round) {
        if (dot(cross(a[0], a[1]), a[2]) < 0) a[2] = opposite(a[2]);
        std::array<Vec3, 3> next{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 c = unit_or_zero(cross(a[(i + 1) % 3], a[(i + 2) % 3]));
            next[i] = unit_or_zero({a[i][0] + c[0], a[i][1] + c[1], a[i][2] + c[2]});
        }
        a = next;
    }
    return a;
}

// The near-orthogonal triple with the largest weight. The third may be the cross product of the
// other two: a single view often shows only two directions well.
Triple best_triple(const WeightedNormals& normals, const std::vector<Vec3>& directions) {
    Triple best;
    const double most_dot = std::sin(near_degrees * std::numbers::pi / 180);
    const auto consider = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        if (std::abs(dot(a, b)) > most_dot || std::abs(dot(a, c)) > most_dot ||
            std::abs(dot(b, c)) > most_dot) {
            return;
        }
        Triple triple;
        triple.axes = orthogonalise({a, b, c});
        for (std::size_t i = 0; i < 3; ++i) {
            triple.share[i] = weight_near(normals, triple.axes[i], near_degrees) / normals.total;
            triple.total += triple.share[i];
        }
        if (triple.total > best.total) best = triple;
    };
    for (std::size_t i = 0; i < directions.size(); ++i) {
        for (std::size_t j = i + 1; j < directions.size(); ++j) {
            if (std::abs(dot(directions[i], directions[j])) > most_dot) continue;
            consider(directions[i], directions[j],
                     unit_or_zero(cross(directions[i], directions[j])));
            for (std::size_t k = j + 1; k < directions.size(); ++k) {
                consider(directions[i], directions[j], directions[k]);
            }
        }
    }
    return best;
}

// The direction of v at right angles to up.
Vec3 level_part(const Vec3& v, const Vec3& up) {
    return unit_or_zero(along(v, -dot(v, up), up));
}

// Horizontal axes: the fourfold direction that most upright surfaces follow, found on the normals'
// azimuth and refined; share: how much of the upright surface follows it.
Vec3 horizontal_axis(const WeightedNormals& normals, const Vec3& up, const Vec3& guess,
                     double& share) {
    const Vec3 e1 = level_part(guess, up);
    const Vec3 e2 = cross(up, e1);
    FourfoldHistogram histogram;
    std::vector<std::array<double, 2>> azimuth;  // angle modulo 90 degrees, weight
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const Vec3 n = normals[i];
        if (std::abs(dot(n, up)) > std::sin(near_degrees * std::numbers::pi / 180)) continue;
        double angle = std::atan2(dot(n, e2), dot(n, e1)) * 180 / std::numbers::pi;
        angle -= 90 * std::floor(angle / 90);
        azimuth.push_back({angle, normals.weight[i]});
        histogram.add(angle, normals.weight[i]);
    }
    share = 0;
    const double total = histogram.total();
    if (!(total > 0)) return e1;
    double centre = histogram.peak(3).bin + 0.5;
    for (const double window : {10.0, 6.0, 4.0, 4.0}) {
        double sum = 0, offset = 0;
        for (const auto& [angle, weight] : azimuth) {
            const double d = angle - centre - 90 * std::round((angle - centre) / 90);
            if (std::abs(d) >= window) continue;
            const double taper = 1 - d * d / (window * window);
            sum += weight * taper * taper;
            offset += weight * taper * taper * d;
        }
        if (sum > 0) centre += offset / sum;
    }
    for (const auto& [angle, weight] : azimuth) {
        const double d = angle - centre - 90 * std::round((angle - centre) / 90);
        if (std::abs(d) <= near_degrees) share += weight / total;
    }
    const double turn = centre * std::numbers::pi / 180;
    return {std::cos(turn) * e1[0] + std::sin(turn) * e2[0],
            std::cos(turn) * e1[1] + std::sin(turn) * e2[1],
            std::cos(turn) * e1[2] + std::sin(turn) * e2[2]};
}

// Of the four horizontal directions that a fourfold axis leaves, the one nearest to the input's x,
// so that the frame turns as little as it must.
Vec3 nearest_to_x(const Vec3& axis, const Vec3& up) {
    const Vec3 side = cross(up, axis);
    Vec3 best = axis;
    for (const Vec3& v : {opposite(axis), side, opposite(side)})
        if (v[0] > best[0] + 1e-9) best = v;
    return best;
}

Vec3 any_horizontal(const Vec3& up) {
    const Vec3 e = std::abs(up[0]) < 0.8 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return level_part(e, up);
}

}  // namespace

SceneFrame find_scene_frame(device::Device& device, const Surfels& surfels,
                            const FrameHints& hints) {
    const WeightedNormals normals = weigh_normals(surfels, most_normals);
    std::vector<Vec3> directions = cluster_normals(device, surfels, cluster_count).direction;
    for (Vec3& direction : directions) direction = refine_axis(normals, direction);
    const Triple triple = best_triple(normals, directions);
    const bool manhattan =
        triple.total >= least_total_share &&
        *std::min_element(triple.share.begin(), triple.share.end()) >= least_axis_share;

    SceneFrame frame;
    const UpChoice up = choose_up(
        surfels, normals, directions,
        manhattan ? std::vector<Vec3>(triple.axes.begin(), triple.axes.end()) : std::vector<Vec3>{},
        hints);
    frame.up_method = up.method;
    frame.note = up.note;
    frame.axes[2] = up.up;
    // The best triple may hang on furniture; what counts is that upright surfaces follow two
    // directions at right angles to up.
    double share = 0;
    const Vec3 x = horizontal_axis(normals, up.up, any_horizontal(up.up), share);
    frame.axes[0] = nearest_to_x(x, up.up);
    frame.axes[1] = unit_or_zero(cross(frame.axes[2], frame.axes[0]));
    double total = 0, least = 1;
    for (const Vec3& axis : frame.axes) {
        const double near =
            normals.total > 0 ? weight_near(normals, axis, near_degrees) / normals.total : 0;
        total += near;
        least = std::min(least, near);
    }
    frame.found = total >= least_total_share && least >= least_axis_share;
    if (frame.up_method == "dominant-plane" && frame.found) frame.up_method = "manhattan";
    if (frame.up_method == "manhattan" && !frame.found) frame.up_method = "dominant-plane";
    frame.up_share =
        normals.total > 0 ? weight_near(normals, up.up, near_degrees) / normals.total : 0;
    return frame;
}

}  // namespace topple::geometry
