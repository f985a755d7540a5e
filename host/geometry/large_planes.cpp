// SPDX-License-Identifier: MIT
#include "geometry/large_planes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
            facing_.push_back(dot({normals.x[n], normals.y[n], normals.z[n]}, direction));
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
            if (near_[n] && large[static_cast<std::size_t>(at_[n])]) holds[n] = true;
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

}  // namespace topple::geometry
