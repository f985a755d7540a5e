// SPDX-License-Identifier: MIT
#include "geometry/manhattan_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/vectors.h"
#include "geometry/fourfold.h"

namespace topple::geometry {
namespace {

// Two neighbouring bins with this share of the surface make a large plane.
constexpr double large_share = 0.01;
// A bin: a plane that is off by 10 degrees over a small table still falls in few of them.
constexpr double bin_cells = 3;
// Slanted: neither level nor upright, by this much.
constexpr double slant_degrees = 20;
// Of the scene's extent, at either end: where floor and ceiling lie.
constexpr double end_share = 0.1;
// With less than this share of the other, one of them is not there.
constexpr double lone_share = 0.1;
// A scene that is no higher has no ends.
constexpr double least_extent_cells = 10;
// Less surface than this share of all tells nothing of which end is up.
constexpr double telling_share = 0.005;

// Runs along the axis: across its normal, by this much.
constexpr double along_degrees = 6;
// Follows the fourfold direction that most of that surface follows, within this much.
constexpr int followed_degrees = 14;

struct Balance {
    double sum = 0, weight = 0;
    void add(double value, double w) {
        sum += value * w;
        weight += w;
    }
    double mean(double least_weight) const { return weight > least_weight ? sum / weight : 0; }
};

Vec3 across(const Vec3& axis) {
    return unit_or_zero(cross(axis, std::abs(axis[0]) < 0.8 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
}

double turned_share(const WeightedNormals& normals, const LargePlanes& planes, const Vec3& axis) {
    const Vec3 e1 = across(axis), e2 = cross(axis, e1);
    const double most_sine = std::sin(along_degrees * std::numbers::pi / 180);
    FourfoldHistogram all, apart;  // apart: in no large plane
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const Vec3 n{normals.x[i], normals.y[i], normals.z[i]};
        if (std::abs(dot(n, axis)) >= most_sine) continue;
        const double degrees = std::atan2(dot(n, e2), dot(n, e1)) * 180 / std::numbers::pi + 360;
        all.add(degrees, normals.weight[i]);
        if (!planes.holds[i]) apart.add(degrees, normals.weight[i]);
    }
    const int followed = all.peak(followed_degrees).bin;
    return (apart.total() - apart.around(followed, followed_degrees)) / normals.total;
}

}  // namespace

Profile profile_along(const Surfels& s, const WeightedNormals& normals, const LargePlanes& planes,
                      const Vec3& axis) {
    Profile result;
    if (normals.size() == 0) return result;
    const auto cosine = [](double degrees) { return std::cos(degrees * std::numbers::pi / 180); };
    const double level_cos = cosine(plane_degrees), slant_high = cosine(slant_degrees),
                 slant_low = cosine(90 - slant_degrees);
    std::vector<double> height(normals.size()), facing(normals.size());
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const std::uint32_t k = normals.surfel[i];
        height[i] = s.x[k] * axis[0] + s.y[k] * axis[1] + s.z[k] * axis[2];
        facing[i] = normals.x[i] * axis[0] + normals.y[i] * axis[1] + normals.z[i] * axis[2];
    }
    const auto [lowest, highest] = std::ranges::minmax_element(height);
    const double low = *lowest, high = *highest;
    std::vector<double> ordered = height;
    const auto ranked = [&](std::size_t rank) {
        const auto at = ordered.begin() + static_cast<std::ptrdiff_t>(rank);
        std::ranges::nth_element(ordered, at);
        return *at;
    };
    const std::size_t outside = ordered.size() / 100;
    const double bottom = ranked(outside), top = ranked(ordered.size() - 1 - outside);
    result.extent_m = top - bottom;
    const double bin = bin_cells * s.cell_m;
    const auto bin_of = [&](double h) { return static_cast<std::size_t>((h - low) / bin); };
    std::vector<double> level(bin_of(high) + 2);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (std::abs(facing[i]) >= level_cos) level[bin_of(height[i])] += normals.weight[i];
    }
    const auto large = [&](std::size_t b) {
        const double pair = level[b] + level[b + 1], before = b > 0 ? level[b - 1] + level[b] : 0;
        return std::max(pair, before) >= large_share * normals.total;
    };
    Balance middle, clutter;
    double floor = 0, ceiling = 0, lower = 0, upper = 0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const double w = normals.weight[i], f = std::abs(facing[i]);
        const double part = result.extent_m > 0 ? (height[i] - bottom) / result.extent_m : 0.5;
        const bool inner = part > end_share && part < 1 - end_share;
        if (f >= level_cos) {
            if (large(bin_of(height[i]))) (facing[i] > 0 ? result.along : result.against) += w;
            if (inner) {
                middle.add(facing[i] > 0 ? 1 : -1, w);
            } else {
                (facing[i] > 0 ? floor : ceiling) += w;
                (part < 0.5 ? lower : upper) += w;
            }
        } else if (f < slant_high && f > slant_low && part >= 0 && part <= 1 && !planes.holds[i]) {
            clutter.add(1 - 2 * part, w);
        }
    }
    result.along /= normals.total;
    result.against /= normals.total;
    const double least = telling_share * normals.total;
    result.level_facing = middle.mean(least);
    const auto lone = [&](double low_end, double high_end) -> double {
        const bool one = std::min(low_end, high_end) < lone_share * std::max(low_end, high_end);
        return !one || low_end + high_end <= least ? 0 : low_end > high_end ? 1 : -1;
    };
    result.lone_end = lone(floor, ceiling);
    if (result.extent_m > least_extent_cells * s.cell_m) result.lone_place = lone(lower, upper);
    result.clutter_low = clutter.mean(least);
    result.turned = turned_share(normals, planes, axis);
    return result;
}

}  // namespace topple::geometry
