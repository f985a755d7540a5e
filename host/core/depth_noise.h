// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace topple {

// Standard deviation of one depth reading of a structured-light sensor, metres, at depth z metres:
// least + growth * max(z - from, 0)^2, the axial noise of Nguyen, Izadi & Lovell 2012, seen head
// on.
inline constexpr double least_depth_sigma = 0.0012;    // m
inline constexpr double depth_sigma_growth = 0.0019;   // 1/m
inline constexpr double depth_sigma_grows_from = 0.4;  // m

template <class Real>
Real depth_sigma(Real z) {
    // Above 0 that, else 0: without a branch, so that compilers vectorise it.
    const Real past = z - Real(depth_sigma_grows_from);
    const Real beyond = Real(0.5) * (past + std::abs(past));
    return Real(least_depth_sigma) + Real(depth_sigma_growth) * beyond * beyond;
}

}  // namespace topple
