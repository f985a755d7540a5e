// SPDX-License-Identifier: MIT
#pragma once

namespace topple::geometry {

inline constexpr double least_depth_sigma = 0.0012;

// Standard deviation of one depth reading, metres, at depth z metres: the structured-light model of
// Nguyen, Izadi & Lovell 2012 (their axial noise, seen head on).
template <class Real>
Real depth_sigma(Real z) {
    const Real beyond = z > Real(0.4) ? z - Real(0.4) : Real(0);
    return Real(least_depth_sigma) + Real(0.0019) * beyond * beyond;
}

}  // namespace topple::geometry
