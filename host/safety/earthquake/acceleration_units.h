// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

// Units of acceleration, as options and records of shaking name them.
namespace topple::io {

inline constexpr double g_m_s2 = 9.80665;  // standard gravity

// m/s^2 in one, in any case: g, m/s^2 or cm/s^2 (Gal), in all their spellings; none where it is no
// unit of acceleration.
std::optional<double> acceleration_unit_m_s2(std::string_view name);

}  // namespace topple::io
