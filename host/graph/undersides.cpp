// SPDX-License-Identifier: MIT
#include "graph/undersides.h"

namespace topple::graph {

Table<ObjectId, std::vector<Underside>> undersides(const SolidCells& cells, ObjectOf object_of,
                                                   std::size_t objects) {
    Table<ObjectId, std::vector<Underside>> out(objects);
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const ObjectId own = object_of(cells.primitive[n]);
        if (own < 0) continue;
        // Cells are sorted by (i, j, k): what is below comes right before.
        const bool below = n > 0 && cells.i[n - 1] == cells.i[n] && cells.j[n - 1] == cells.j[n];
        if (below && object_of(cells.primitive[n - 1]) == own) continue;
        std::vector<Underside>& columns = out[own];
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
