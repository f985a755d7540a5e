// SPDX-License-Identifier: MIT
#pragma once

#include <queue>

#include "standard.h"

namespace topple::oracle {

// L(v), the least highest energy on a path from the start, as Dijkstra's algorithm finds it: the
// lowest level known is final, each direction is settled once. neighbour: degree per direction.
inline std::vector<float> flood(const std::vector<float>& energy,
                                const std::vector<std::uint32_t>& neighbour, std::size_t degree,
                                std::uint32_t start) {
    std::vector<float> level(energy.size(), 3.0e38f);
    std::vector<bool> settled(energy.size(), false);
    using Entry = std::pair<float, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    level[start] = energy[start];
    open.push({level[start], start});
    while (!open.empty()) {
        const std::uint32_t v = open.top().second;
        open.pop();
        if (settled[v]) continue;
        settled[v] = true;
        for (std::size_t k = 0; k < degree; ++k) {
            const std::uint32_t w = neighbour[v * degree + k];
            const float through = std::max(level[v], energy[w]);
            if (through >= level[w]) continue;
            level[w] = through;
            open.push({through, w});
        }
    }
    return level;
}

}  // namespace topple::oracle
