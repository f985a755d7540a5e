// SPDX-License-Identifier: MIT
#include "geometry/manhattan_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/ranked.h"
#include "core/vectors.h"
#include "geometry/fourfold.h"

namespace topple::geometry {
namespace {

// Two neighbouring slabs, of so many cells each, with this share of the surface hold such a plane.
constexpr double plane_share = 0.05, slab_cells = 3;
constexpr std::size_t beside = 2;  // slabs from a plane in which noise may lie
// With less of the surface than that clear of a plane, nothing lies before it or behind it.
constexpr double least_clear_share = 0.03;

// The slabs across one direction.
class Slabs {
  public:
    Slabs(const Surfels& s, const WeightedNormals& normals, const Vec3& direction)
        : normals_(normals) {
        const double least_cos = std::cos(near_degrees * std::numbers::pi / 180);
        double low = INFINITY, high = -INFINITY;
        for (std::size_t n = 0; n < normals.size(); ++n) {
            const std::uint32_t k = normals.surfel[n];
            at_.push_back(dot({s.x[k], s.y[k], s.z[k]}, direction));
            low = std::min(low, at_.back());
            high = std::max(high, at_.back());
            facing_.push_back(dot(normals[n], direction));
        }
        const double edge = slab_cells * s.cell_m;
        all_.resize(static_cast<std::size_t>((high - low) / edge) + 2);
        across_ = facing_across_ = all_;
        for (std::size_t n = 0; n < normals.size(); ++n) {
            at_[n] = std::floor((at_[n] - low) / edge);
            const auto slab = static_cast<std::size_t>(at_[n]);
            const double w = normals.weight[n];
            all_[slab] += w;
            near_.push_back(std::abs(facing_[n]) >= least_cos);
            if (!near_.back()) continue;
            across_[slab] += w;
            facing_across_[slab] += facing_[n] > 0 ? w : -w;
        }
    }

    // Marks what lies in large planes; adds their weights, and what encloses of those.
    void add(std::vector<bool>& holds, double& weight, double& enclosing) const {
        std::vector<bool> large(all_.size(), false);
        for (std::size_t b = 0; b + 1 < all_.size(); ++b) {
            const double pair = across_[b] + across_[b + 1];
            const bool highest = (b == 0 || across_[b - 1] + across_[b] < pair) &&
                                 (b + 2 >= all_.size() || across_[b + 1] + across_[b + 2] <= pair);
            if (pair < plane_share * normals_.total) continue;
            large[b] = large[b + 1] = true;
            if (!highest) continue;
            const double faces = (facing_across_[b] + facing_across_[b + 1]) / pair;
            weight += pair;
            enclosing += pair * faces * lean(b);
        }
        for (std::size_t n = 0; n < normals_.size(); ++n)
            if (near_[n] && large[at_[n]]) holds[n] = true;
    }

  private:
    // Of what lies clear of a plane in slabs b and b + 1 the share above it less that below it.
    double lean(std::size_t b) const {
        double above = 0, below = 0;
        for (std::size_t k = 0; k < all_.size(); ++k) {
            if (k + beside < b) below += all_[k];
            if (k > b + 1 + beside) above += all_[k];
        }
        return above + below > least_clear_share * normals_.total
                   ? (above - below) / (above + below)
                   : 0;
    }

    const WeightedNormals& normals_;
    std::vector<double> at_, facing_;  // by normal; at_: its slab
    std::vector<bool> near_;           // by normal, whether it is across the direction
    std::vector<double> all_, across_, facing_across_;  // by slab
};

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
        const Vec3 n = normals[i];
        if (std::abs(dot(n, axis)) >= most_sine) continue;
        const double degrees = std::atan2(dot(n, e2), dot(n, e1)) * 180 / std::numbers::pi + 360;
        all.add(degrees, normals.weight[i]);
        if (!planes.holds[i]) apart.add(degrees, normals.weight[i]);
    }
    const int followed = all.peak(followed_degrees).bin;
    return (apart.total() - apart.around(followed, followed_degrees)) / normals.total;
}

}  // namespace

LargePlanes find_large_planes(const Surfels& surfels, const WeightedNormals& normals,
                              const std::vector<Vec3>& directions) {
    LargePlanes out;
    out.holds.assign(normals.size(), false);
    if (normals.size() == 0) return out;
    double weight = 0;
    for (const Vec3& direction : directions)
        Slabs(surfels, normals, direction).add(out.holds, weight, out.enclosing);
    if (weight > 0) out.enclosing /= weight;
    return out;
}

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
        height[i] = dot({s.x[k], s.y[k], s.z[k]}, axis);
        facing[i] = dot(normals[i], axis);
    }
    const auto [lowest, highest] = std::ranges::minmax_element(height);
    const double low = *lowest, high = *highest;
    std::vector<double> ordered = height;
    const std::size_t outside = ordered.size() / 100;
    const double bottom = ranked(ordered, outside),
                 top = ranked(ordered, ordered.size() - 1 - outside);
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
