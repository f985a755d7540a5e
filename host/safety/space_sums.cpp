// SPDX-License-Identifier: MIT
#include "safety/space_sums.h"

#include <algorithm>
#include <utility>

namespace topple::safety {

void SpaceSums::add(const std::array<std::int32_t, 3>& cell, const Passing& passing) {
    if (passing.passes > 0) entries_.push_back({cell, passing});
}

void SpaceSums::add(const SpaceField& field, float share) {
    for (std::size_t n = 0; n < field.size(); ++n) {
        Passing all;
        const float passes = field.frequency[n];
        const auto& v = field.velocity_m_s[n];
        all.add({passes, {passes * v[0], passes * v[1], passes * v[2]}, passes * field.energy[n]},
                share);
        add(field.cell[n], all);
    }
}

SpaceField SpaceSums::take() {
    SpaceField out;
    out.corner_m = corner_m_;
    for (std::size_t a = 0; a < 3; ++a) out.along_m[a][a] = cell_m_;
    // Stable: the sums' order is that in which they came.
    std::ranges::stable_sort(entries_, {}, &Entry::cell);
    for (std::size_t n = 0; n < entries_.size();) {
        Passing all;
        const std::array<std::int32_t, 3> cell = entries_[n].cell;
        for (; n < entries_.size() && entries_[n].cell == cell; ++n) all.add(entries_[n].passing);
        out.cell.push_back(cell);
        out.frequency.push_back(all.passes);
        out.energy.push_back(all.energy / all.passes);
        auto& v = out.velocity_m_s.emplace_back(all.velocity);
        for (float& along : v) along /= all.passes;
    }
    entries_ = {};
    return out;
}

}  // namespace topple::safety
