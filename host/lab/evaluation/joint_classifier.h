// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "graph/contact_graph.h"
#include "physics/bodies.h"

// The paper's first baseline of Table 3: each joint is judged by itself, from what it looks like,
// by a logistic regression with weights fitted to scenes whose truth is known. It knows nothing of
// energies.
namespace topple::evaluation {

// What a joint of two primitives looks like. Logarithms are to base 10, of ratios not below 1e-4.
//   0  1
//   1  log of the contact's area over the smaller face of the two across its normal
//   2  log of the same over the larger face
//   3  log of the contact's area in square metres
//   4  the upward part of the normal, 0 to 1
//   5  log of the smaller volume over the larger
//   6  overlap of both in height over the smaller height
//   7  1 where one rests on the other
//   8  1 where one is of the room's shell
constexpr std::size_t joint_features = 9;
using JointFeatures = std::array<double, joint_features>;
using JointWeights = std::array<double, joint_features>;

// Fitted to generated rooms that are not those of the evaluation, by
//   topple evaluate --fit-joints --seeds 8 --first 1001
inline constexpr JointWeights fitted_joint_weights{-0.2928, 0.5854, 1.2190,  -1.1987, -0.4956,
                                                   0.1490,  1.5973, -0.0406, -1.0715};

// Of each pair of the contact graph, in its order. shell: by primitive.
std::vector<JointFeatures> features_of(const graph::ContactGraph& contacts,
                                       std::span<const physics::MassProperties> bodies,
                                       const std::vector<bool>& shell);

double probability(const JointWeights& weights, const JointFeatures& features);

// The weights w that minimise -sum log p(fixed | features) + ridge |w|^2 / 2, the constant's weight
// free, by Newton's method; all 0 without an example. Throws Error(usage) where sizes differ.
JointWeights fit_joints(std::span<const JointFeatures> joints, const std::vector<bool>& fixed,
                        double ridge = 1);

// Joins what touches at a probability above a half; pinned primitives are one group, -1, the others
// are numbered by first appearance.
std::vector<std::int32_t> join_by_probability(const graph::ContactGraph& contacts,
                                              std::span<const JointFeatures> joints,
                                              const JointWeights& weights,
                                              const std::vector<bool>& pinned);

}  // namespace topple::evaluation
