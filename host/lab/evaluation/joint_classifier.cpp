// SPDX-License-Identifier: MIT
#include "lab/evaluation/joint_classifier.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/union_find.h"
#include "topple/error.h"

namespace topple::evaluation {
namespace {

double log_ratio(double part, double whole) {
    return whole > 0 ? std::log10(std::clamp(part / whole, 1e-4, 1e4)) : 0;
}

}  // namespace

std::vector<JointFeatures> features_of(const graph::ContactGraph& contacts,
                                       std::span<const physics::MassProperties> bodies,
                                       const std::vector<bool>& shell) {
    const auto carries = [&](std::int32_t a, std::int32_t b) {
        return std::ranges::any_of(contacts.carriers_of(b),
                                   [&](const graph::Carrying& c) { return c.supporter == a; });
    };
    std::vector<JointFeatures> out;
    for (const physics::TouchingPair& pair : contacts.pairs) {
        const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
        std::size_t axis = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (std::abs(pair.normal[k]) > std::abs(pair.normal[axis])) axis = k;
        const auto [small, large] =
            std::minmax(contacts.silhouette_m2[a][axis], contacts.silhouette_m2[b][axis]);
        const auto [light, heavy] = std::minmax(bodies[a].volume_m3, bodies[b].volume_m3);
        const double least_height = std::min(contacts.highest_m[a] - contacts.lowest_m[a],
                                             contacts.highest_m[b] - contacts.lowest_m[b]);
        const double overlap = std::min(contacts.highest_m[a], contacts.highest_m[b]) -
                               std::max(contacts.lowest_m[a], contacts.lowest_m[b]);
        out.push_back({1, log_ratio(pair.area_m2, small), log_ratio(pair.area_m2, large),
                       log_ratio(pair.area_m2, 1), std::abs(pair.normal[2]),
                       log_ratio(light, heavy),
                       least_height > 0 ? std::clamp(overlap / least_height, 0.0, 1.0) : 0,
                       carries(pair.a, pair.b) || carries(pair.b, pair.a) ? 1.0 : 0.0,
                       shell[a] || shell[b] ? 1.0 : 0.0});
    }
    return out;
}

double probability(const JointWeights& weights, const JointFeatures& features) {
    return 1 / (1 + std::exp(-std::inner_product(weights.begin(), weights.end(), features.begin(),
                                                 0.0)));
}

JointWeights fit_joints(std::span<const JointFeatures> joints, const std::vector<bool>& fixed,
                        double ridge) {
    if (joints.size() != fixed.size()) {
        throw Error(ErrorKind::usage, "fit_joints: " + std::to_string(joints.size()) +
                                          " joints, but the truth of " +
                                          std::to_string(fixed.size()));
    }
    JointWeights weights{};
    if (joints.empty()) return weights;
    constexpr auto n = static_cast<Eigen::Index>(joint_features);
    // Newton's steps double the digits; the ridge keeps them from running off.
    for (int step = 0; step < 50; ++step) {
        Eigen::VectorXd slope = Eigen::VectorXd::Zero(n);
        Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(n, n);
        for (Eigen::Index k = 1; k < n; ++k) {
            slope[k] = ridge * weights[k];
            curvature(k, k) = ridge;
        }
        for (std::size_t j = 0; j < joints.size(); ++j) {
            const Eigen::Map<const Eigen::VectorXd> x(joints[j].data(), n);
            const double p = probability(weights, joints[j]);
            slope += (p - (fixed[j] ? 1 : 0)) * x;
            curvature += p * (1 - p) * x * x.transpose();
        }
        curvature(0, 0) += 1e-9;  // where all are fixed, or none
        const Eigen::VectorXd move = curvature.ldlt().solve(slope);
        const double scale = std::min(1.0, 5 / std::max(move.norm(), 1e-300));
        for (Eigen::Index k = 0; k < n; ++k) weights[k] -= scale * move[k];
        if (move.norm() < 1e-10) break;
    }
    return weights;
}

std::vector<std::int32_t> join_by_probability(const graph::ContactGraph& contacts,
                                              std::span<const JointFeatures> joints,
                                              const JointWeights& weights,
                                              const std::vector<bool>& pinned) {
    UnionFind sets(pinned.size());
    const auto ground = static_cast<std::size_t>(std::ranges::find(pinned, true) - pinned.begin());
    for (std::size_t n = ground; n < pinned.size(); ++n)
        if (pinned[n]) sets.join(ground, n);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const physics::TouchingPair& pair = contacts.pairs[j];
        if (probability(weights, joints[j]) > 0.5)
            sets.join(static_cast<std::size_t>(pair.a), static_cast<std::size_t>(pair.b));
    }
    std::map<std::size_t, std::int32_t> label;
    if (ground < pinned.size()) label[sets.root(ground)] = -1;
    std::int32_t next = 0;
    std::vector<std::int32_t> out;
    for (std::size_t n = 0; n < pinned.size(); ++n) {
        const auto [at, fresh] = label.try_emplace(sets.root(n), next);
        next += fresh;
        out.push_back(at->second);
    }
    return out;
}

}  // namespace topple::evaluation
