// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>

#include "core/ranked.h"
#include "core/sorted_order.h"
#include "geometry/algebraic_model.h"
#include "geometry/face_limits.h"
#include "geometry/split.h"

namespace topple::geometry {

namespace {

constexpr std::size_t fit_sample = 2000;  // points that a quadric's fit looks at: for its time
constexpr int quadric_rounds = 8;         // of growing and fitting, at most

// A plane whose own surfels turn less than this under a quadric (degrees from their mean, 90th
// percentile) is flat: then no two of them differ by more than surfels of a plane always may.
constexpr double flat_turn_deg = least_angle_deg / 2;
// What a quadric must gain over the plane that it grew from, in surfels. Set by hand.
constexpr double least_quadric_gain = 1.25;
// Largest rms angle between a quadric and its surfels' normals, as a share of the angle that is
// allowed: angles that are spread evenly up to that, as of a quadric bent through the faces of a
// box, have 1 / sqrt(3) = 0.58.
constexpr double most_quadric_angle_share = 0.55;

using Members = std::vector<std::uint32_t>;

class Grower {
  public:
    Grower(const Surfels& surfels, const SplitScale& scale, ThreadPool& threads)
        : s_(surfels), scale_(scale), threads_(threads), cos_angle_(std::cos(scale.angle_rad)) {
        out_.label.assign(s_.size(), -1);
        seen_.assign(s_.size(), 0);
    }

    Regions run() {
        // Of lengths the bits sort as the numbers do.
        std::vector<std::uint64_t> roughness(s_.size());
        for (std::size_t i = 0; i < s_.size(); ++i)
            roughness[i] = std::bit_cast<std::uint32_t>(s_.roughness_m[i]);
        for (const std::uint32_t seed : sorted_order(roughness)) {
            if (out_.label[seed] >= 0 || normal(s_, seed).squaredNorm() < 0.5) continue;
            threads_.poll();
            grow_from(seed);
        }
        return std::move(out_);
    }

  private:
    void grow_from(std::uint32_t seed) {
        AlgebraicModel model;
        Members members = grow_plane(seed, model);
        if (members.size() < least_region) return;
        if (bends(members)) {
            AlgebraicModel quadric;
            const Members curved = grow_quadric(members, quadric);
            if (static_cast<double>(curved.size()) >
                    least_quadric_gain * static_cast<double>(members.size()) &&
                follows_normals(curved, quadric)) {
                members = curved;
                model = quadric;
            }
        }
        const auto id = static_cast<std::int32_t>(out_.regions.size());
        for (const std::uint32_t i : members) out_.label[i] = id;
        out_.regions.push_back({model, 0, members.size()});
    }

    bool fits(const AlgebraicModel& model, std::uint32_t i) const {
        const Eigen::Vector3d p = position(s_, i), n = normal(s_, i);
        if (std::abs(distance(model, p)) > scale_.tolerance_m[i]) return false;
        const Eigen::Vector3d g = gradient(model, p);
        return n.dot(g) > cos_angle_ * g.norm();
    }

    // Breadth-first from `start` over unlabelled surfels that fit; `add` hears of each and may move
    // the model.
    template <typename Add>
    Members flood(const Members& start, const AlgebraicModel& model, Add add) {
        ++stamp_;
        Members members;
        for (const std::uint32_t i : start) {
            if (!fits(model, i)) continue;
            seen_[i] = stamp_;
            members.push_back(i);
        }
        for (std::size_t head = 0; head < members.size(); ++head) {
            const std::uint32_t i = members[head];
            for (const std::uint32_t j : s_.around(i)) {
                if (seen_[j] == stamp_ || out_.label[j] >= 0 || !fits(model, j)) continue;
                seen_[j] = stamp_;
                members.push_back(j);
                add(j);
            }
        }
        return members;
    }

    Members grow_plane(std::uint32_t seed, AlgebraicModel& model) {
        PlaneMoments moments;
        moments.add(position(s_, seed), normal(s_, seed));
        model = fit_plane(moments, scale_.layer_m);
        std::uint64_t refit_at = 8;
        Members members = flood({seed}, model, [&](std::uint32_t j) {
            moments.add(position(s_, j), normal(s_, j));
            if (moments.count < refit_at) return;
            model = fit_plane(moments, scale_.layer_m);
            refit_at += refit_at / 2;
        });
        model = fit_plane(moments, scale_.layer_m);
        // The model moved while it grew: what it no longer explains is free again.
        std::erase_if(members, [&](std::uint32_t i) { return !fits(model, i); });
        return members;
    }

    AlgebraicModel fit(const Members& members) {
        points_.clear();
        normals_.clear();
        const std::size_t step = members.size() / fit_sample + 1;
        for (std::size_t k = 0; k < members.size(); k += step) {
            points_.push_back(position(s_, members[k]));
            normals_.push_back(normal(s_, members[k]));
        }
        return fit_quadric(points_, normals_, scale_.layer_m);
    }

    // Whether a quadric through the plane's own surfels turns: the surface is curved, not flat.
    bool bends(const Members& members) {
        const AlgebraicModel quadric = fit(members);
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        std::vector<Eigen::Vector3d> direction;
        for (const auto& p : points_) {
            direction.push_back(gradient(quadric, p).normalized());
            mean += direction.back();
        }
        mean.normalize();
        std::vector<double> cosine;
        for (const auto& d : direction) cosine.push_back(d.dot(mean));
        return ranked(cosine, cosine.size() / 10) < std::cos(flat_turn_deg * EIGEN_PI / 180);
    }

    Members grow_quadric(const Members& start, AlgebraicModel& model) {
        Members members = start;
        for (int round = 0; round < quadric_rounds; ++round) {
            model = fit(members);
            Members grown = flood(members, model, [](std::uint32_t) {});
            const bool settled = grown.size() < members.size() + members.size() / 50 + 1;
            members.swap(grown);
            if (settled || members.empty()) break;
        }
        return members;
    }

    // A quadric can be bent through the faces of a box; its normals then miss those of the surface.
    bool follows_normals(const Members& members, const AlgebraicModel& model) const {
        double sum = 0;
        for (const std::uint32_t i : members) {
            const double c = normal(s_, i).dot(gradient(model, position(s_, i)).normalized());
            const double angle = std::acos(std::clamp(c, -1.0, 1.0));
            sum += angle * angle;
        }
        const double rms = std::sqrt(sum / static_cast<double>(members.size()));
        return rms < most_quadric_angle_share * scale_.angle_rad;
    }

    const Surfels& s_;
    const SplitScale& scale_;
    ThreadPool& threads_;
    double cos_angle_;
    Regions out_;
    std::vector<std::uint32_t> seen_;
    std::uint32_t stamp_ = 0;
    std::vector<Eigen::Vector3d> points_, normals_;
};

}  // namespace

Regions grow_regions(const Surfels& surfels, const SplitScale& scale, ThreadPool& threads) {
    return Grower(surfels, scale, threads).run();
}

}  // namespace topple::geometry
