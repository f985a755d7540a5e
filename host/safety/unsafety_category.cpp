// SPDX-License-Identifier: MIT
#include "safety/unsafety_category.h"

#include <algorithm>
#include <array>

namespace topple::safety {

const char* to_string(Category category) {
    static constexpr std::array names{"none", "low", "medium", "high"};
    return names[static_cast<std::size_t>(category)];
}

Category category(double chance, double energy_J) {
    if (!(chance > 0) || !(energy_J >= slight_J)) return Category::none;
    const int likelihood =
        (chance >= unlikely_chance) + (chance >= possible_chance) + (chance >= likely_chance);
    const int severity = 1 + (energy_J >= serious_J) + (energy_J >= deadly_J);
    switch (likelihood + severity) {
        case 1:
            return Category::none;
        case 2:
        case 3:
            return Category::low;
        case 4:
            return Category::medium;
        default:
            return Category::high;
    }
}

Category CategoryEnds::worst() const {
    return std::max({lower, measured, higher});
}

bool CategoryEnds::certain() const {
    return lower == measured && measured == higher;
}

Category category(const Risk& risk, double mass_factor) {
    return risk.chance > 0 ? category(risk.chance, mass_factor * risk.mean_J / risk.chance)
                           : Category::none;
}

}  // namespace topple::safety
