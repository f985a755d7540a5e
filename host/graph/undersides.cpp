// SPDX-License-Identifier: MIT
#include "graph/undersides.h"

namespace topple::graph {

std::vector<std::vector<Underside>> undersides(const SolidCells& cells,
                                               std::span<const std::int32_t> object_of_primitive,
                                               std::size_t objects) {
    std::vector<std::vector<Underside>> out(objects);
    const auto object = [&](std::size_t n) {
        const std::int32_t p = cells.primitive[n];
        return p < 0 ? -1 : object_of_primitive[static_cast<std::size_t>(p)];
    };
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t own = object(n);
        if (own < 0) continue;
        // Cells are sorted by (i, j, k): what is below comes right before.
        const bool below = n > 0 && cells.i[n - 1] == cells.i[n] && cells.j[n - 1] == cells.j[n];
        if (below && object(n - 1) == own) continue;
        std::vector<Underside>& columns = out[static_cast<std::size_t>(own)];
        // Only the lowest of each column.
        if (!columns.empty() && columns.back().i == cells.i[n] && columns.back().j == cells.j[n])
            continue;
        columns.push_back({cells.i[n], cells.j[n], cells.k[n],
                           below ? cells.k[n] - cells.k[n - 1] - 1 : -1,
                           below ? cells.primitive[n - 1] : -1, cells.primitive[n],
                           cells.unseen_below.empty() ? 0 : cells.unseen_below[n]});
    }
    return out;
}

}  // namespace topple::graph
