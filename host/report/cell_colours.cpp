// SPDX-License-Identifier: MIT
#include "report/cell_colours.h"

#include <utility>

namespace topple::report {

void CellColours::add(std::uint32_t cell, const Rgb8& colour) {
    if (colour != Rgb8{0, 0, 0}) sums_[cell].add(colour);
}

std::vector<std::optional<Rgb8>> CellColours::spread(
    const CellTable& table, const std::vector<std::array<std::int32_t, 3>>& index,
    const std::vector<std::int32_t>& body) const {
    std::vector<std::optional<Rgb8>> out(sums_.size());
    std::vector<std::uint32_t> ring;
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        if (sums_[i].count == 0) continue;
        out[i] = sums_[i].mean();
        ring.push_back(i);
    }
    // All of a ring read the rings before: the result does not depend on the order of the cells.
    std::vector<ColourSum> around(out.size());
    for (std::vector<std::uint32_t> next; !ring.empty(); std::swap(ring, next)) {
        next.clear();
        for (const std::uint32_t i : ring) {
            each_beside(index[i], table, [&](std::uint32_t other) {
                if (body[other] != body[i] || out[other]) return;
                if (around[other].count == 0) next.push_back(other);
                around[other].add(*out[i]);
            });
        }
        for (const std::uint32_t i : next) out[i] = around[i].mean();
    }
    return out;
}

}  // namespace topple::report
