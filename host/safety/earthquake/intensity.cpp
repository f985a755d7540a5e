// SPDX-License-Identifier: MIT
#include "safety/earthquake/intensity.h"

#include <algorithm>
#include <array>
#include <limits>

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

}  // namespace topple::safety
