// SPDX-License-Identifier: MIT
#pragma once

namespace topple::geometry {

// Standard deviation of one depth reading, metres, at depth z metres: the structured-light model of
// Nguyen, Izadi & Lovell 2012 (their axial noise, seen head on).
inline double depth_sigma(double z) {
    const double beyond = z > 0.4 ? z - 0.4 : 0.0;
    return 0.0012 + 0.0019 * beyond * beyond;
}
inline constexpr double least_depth_sigma = 0.0012;

}  // namespace topple::geometry
