// SPDX-License-Identifier: MIT
#include "safety/earthquake/intensity.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/number_text.h"
#include "io/text.h"
#include "physics/landscape.h"

namespace topple::safety {

std::span<const Intensity> intensities() {
    static constexpr std::array<Intensity, 9> all{
        {{0.0017, "not felt", "I"},
         {0.014, "weak shaking", "II to III"},
         {0.039, "light shaking", "IV"},
         {0.092, "moderate shaking", "V"},
         {0.18, "strong shaking", "VI"},
         {0.34, "very strong shaking", "VII"},
         {0.65, "severe shaking", "VIII"},
         {1.24, "violent shaking", "IX"},
         {std::numeric_limits<double>::infinity(), "extreme shaking", "X or more"}}};
    return all;
}

std::string shaking_text(double pga_g) {
    const auto all = intensities();
    const auto found =
        std::ranges::find_if(all, [&](const Intensity& i) { return pga_g <= i.up_to_g; });
    const Intensity& felt = found == all.end() ? all.back() : *found;
    return std::string(felt.word) + ", intensity " + felt.number;
}

std::string unlikely_peak_note(double pga_m_s2) {
    // Of the level peaks of strong-motion records only a few reach 2 g.
    constexpr double hardly_meant_m_s2 = 1, hardly_recorded_g = 2, hundredth = 0.01;
    const double in_g = pga_m_s2 / physics::gravity;
    const bool weak = pga_m_s2 < hardly_meant_m_s2;
    if (!weak && in_g < hardly_recorded_g) return "";
    const std::string given = io::short_number(pga_m_s2);
    const std::string meant = to_digits(pga_m_s2 * physics::gravity * (weak ? 1 : hundredth), 3);
    std::string note = "pga_m_s2 (--pga) = " + given;
    note.append(" is ").append(io::two_digits(in_g)).append(" g (");
    note.append(shaking_text(in_g)).append(")");
    if (!weak) note.append(", stronger than nearly all that were recorded");
    note.append(weak ? ": for " : "; for ").append(given).append(weak ? " g" : " % of g");
    return note.append(" give pga_m_s2 (--pga) = ").append(meant).append(".");
}

}  // namespace topple::safety
