// SPDX-License-Identifier: MIT
#include "export/cell_grid.h"

#include <numeric>
#include <string>
#include <utility>

#include "topple/error.h"

namespace topple::exports {
namespace {

// Work goes layer by layer.
void check_together(const std::vector<Cell>& cells) {
    constexpr std::size_t few = 4096, each = 64;
    Extents<std::int32_t> box;
    for (const Cell& cell : cells) box.add(cell.at);
    for (std::size_t a = 0; a < 3; ++a)
        if (layers_of(box, a) > few + each * cells.size())
            throw Error(ErrorKind::input, "the solids have a part of " +
                                              std::to_string(cells.size()) + " voxels in " +
                                              std::to_string(layers_of(box, a)) +
                                              " layers; parse the scan again");
}

}  // namespace

CellGrid::CellGrid(std::vector<Cell> cells) : cells_(std::move(cells)), piece_(cells_.size(), -1) {
    if (cells_.empty()) return;
    check_together(cells_);
    std::vector<std::uint32_t> order(cells_.size());
    std::iota(order.begin(), order.end(), 0U);
    // Of cells in one voxel the last one stands for all.
    std::ranges::sort(order, {}, [&](std::uint32_t n) { return std::pair(cells_[n].at, n); });
    const auto last_at = [&](std::size_t m) {
        while (m + 1 < order.size() && cells_[order[m + 1]].at == cells_[order[m]].at) ++m;
        return m;
    };
    for (auto& side : beside_) side.assign(cells_.size(), none);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::size_t m = 0;  // both go through the cells in the same order
        for (std::size_t n = 0; n < order.size(); ++n) {
            Voxel wanted = cells_[order[n]].at;
            ++wanted[axis];
            while (m < order.size() && cells_[order[m]].at < wanted) ++m;
            if (m == order.size()) break;
            if (cells_[order[m]].at != wanted) continue;
            beside_[2 * axis + 1][order[n]] = order[last_at(m)];
            const std::uint32_t here = order[last_at(n)];
            for (std::size_t k = m; k < order.size() && cells_[order[k]].at == wanted; ++k)
                beside_[2 * axis][order[k]] = here;
        }
    }
}

}  // namespace topple::exports
