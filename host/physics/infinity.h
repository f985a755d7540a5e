// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

namespace topple::physics {

// What no barrier, distance or time is found for.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace topple::physics
