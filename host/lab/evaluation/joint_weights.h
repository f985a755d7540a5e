// SPDX-License-Identifier: MIT
#pragma once

#include "lab/evaluation/joint_classifier.h"

namespace topple::evaluation {

// Fitted to generated rooms that are not those of the evaluation, by
//   topple evaluate --fit-joints --seeds 8 --first 1001
inline constexpr JointWeights fitted_joint_weights{-0.2928, 0.5854, 1.2190,  -1.1987, -0.4956,
                                                   0.1490,  1.5973, -0.0406, -1.0715};

}  // namespace topple::evaluation
