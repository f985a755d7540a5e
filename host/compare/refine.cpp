// SPDX-License-Identifier: MIT
#include "compare/refine.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "compare/eigen.h"

namespace topple::comparing {
namespace {

constexpr double search_cell_m = 0.1;
constexpr double least_cosine = 0.7;
constexpr std::size_t most_moved = 6000;
// By step.
constexpr std::array<double, 14> reaches_m{0.2,  0.2,  0.2,  0.15, 0.15, 0.1,  0.1,
                                           0.08, 0.06, 0.05, 0.04, 0.04, 0.04, 0.04};

}  // namespace

Refinement::Cell Refinement::cell_of(const Eigen::Vector3d& place) {
    Cell out{};
    for (int a = 0; a < 3; ++a)
        out[static_cast<std::size_t>(a)] =
            static_cast<std::int64_t>(std::floor(place[a] / search_cell_m));
    return out;
}

Refinement::Refinement(std::span<const SurfacePoint> onto) : onto_(onto) {
    for (std::size_t n = 0; n < onto_.size(); ++n) {
        cells_[cell_of(mapped(onto_[n].place_m))].push_back(n);
        middle_ += mapped(onto_[n].place_m);
    }
    if (!onto_.empty()) middle_ /= static_cast<double>(onto_.size());
}

const SurfacePoint* Refinement::nearest(const Eigen::Vector3d& place, const Eigen::Vector3d& normal,
                                        double reach_m) const {
    const SurfacePoint* best = nullptr;
    double least = reach_m * reach_m;
    const Cell low = cell_of((place.array() - reach_m).matrix()),
               high = cell_of((place.array() + reach_m).matrix());
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
        for (std::int64_t j = low[1]; j <= high[1]; ++j) {
            const auto end = cells_.upper_bound({i, j, high[2]});
            for (auto at = cells_.lower_bound({i, j, low[2]}); at != end; ++at) {
                for (const std::size_t n : at->second) {
                    const SurfacePoint& there = onto_[n];
                    const double square = (mapped(there.place_m) - place).squaredNorm();
                    if (square >= least || mapped(there.normal).dot(normal) < least_cosine)
                        continue;
                    least = square;
                    best = &there;
                }
            }
        }
    }
    return best;
}

Refinement::Refined Refinement::refine(std::span<const SurfacePoint> moved,
                                       const Eigen::Isometry3d& guess) const {
    Refined out;
    out.motion = guess;
    const std::size_t step = 1 + moved.size() / most_moved;
    for (const double reach_m : reaches_m) {
        Eigen::Matrix<double, 6, 6> square = Eigen::Matrix<double, 6, 6>::Zero();
        Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
        double sum = 0, count = 0;
        for (std::size_t n = 0; n < moved.size(); n += step) {
            const Eigen::Vector3d place = out.motion * mapped(moved[n].place_m);
            const SurfacePoint* const there =
                nearest(place, out.motion.linear() * mapped(moved[n].normal), reach_m);
            if (!there) continue;
            const Eigen::Vector3d normal = mapped(there->normal);
            const double off = normal.dot(place - mapped(there->place_m));
            Eigen::Matrix<double, 6, 1> slope;
            slope << (place - middle_).cross(normal), normal;
            square += slope * slope.transpose();
            right += slope * off;
            sum += off * off;
            ++count;
        }
        constexpr double least_matched = 50;
        if (count < least_matched) return out;
        out.error_m = std::sqrt(sum / count);
        // What no surface holds stays.
        square.diagonal().array() += 1e-3 * count;
        const Eigen::Matrix<double, 6, 1> change = -square.ldlt().solve(right);
        const Eigen::Vector3d turn = change.head<3>();
        const double angle = turn.norm();
        Eigen::Isometry3d correction = Eigen::Isometry3d::Identity();
        correction.translate(middle_ + Eigen::Vector3d(change.tail<3>()));
        if (angle > 0) correction.rotate(Eigen::AngleAxisd(angle, turn / angle));
        correction.translate(-middle_);
        out.motion = correction * out.motion;
    }
    return out;
}

}  // namespace topple::comparing
