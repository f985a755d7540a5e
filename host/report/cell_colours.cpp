// SPDX-License-Identifier: MIT
#include "report/cell_colours.h"

#include <algorithm>

namespace topple::report {

void CellColours::Sum::add(const Rgb8& colour) {
    for (std::size_t c = 0; c < 3; ++c) channel[c] += colour[c];
    ++count;
}

Rgb8 CellColours::Sum::mean() const {
    Rgb8 out{};
    for (std::size_t c = 0; c < 3; ++c)
        out[c] = static_cast<std::uint8_t>((channel[c] + count / 2) / count);
    return out;
}

void CellColours::add(std::uint32_t cell, const Rgb8& colour) {
    if (colour != Rgb8{0, 0, 0}) sums_[cell].add(colour);
}

std::vector<CellColours::Known> CellColours::spread(
    const CellTable& table, const std::vector<std::array<std::int32_t, 3>>& index,
    const std::vector<std::int32_t>& body) const {
    std::vector<Known> out(sums_.size());
    std::vector<std::uint32_t> ring;
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        if (sums_[i].count == 0) continue;
        out[i] = {sums_[i].mean(), true};
        ring.push_back(i);
    }
    // All of a ring read the rings before: the result does not depend on the order of the cells.
    std::vector<Sum> around(out.size());
    for (std::vector<std::uint32_t> next; !ring.empty(); std::swap(ring, next)) {
        next.clear();
        for (const std::uint32_t i : ring) {
            for (const auto& near : beside(index[i])) {
                const std::uint32_t other = table.find(near);
                if (other == CellTable::absent || body[other] != body[i] || out[other].known)
                    continue;
                if (around[other].count == 0) next.push_back(other);
                around[other].add(out[i].colour);
            }
        }
        for (const std::uint32_t i : next) out[i] = {around[i].mean(), true};
    }
    return out;
}

}  // namespace topple::report
