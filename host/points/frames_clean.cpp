// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "core/depth_noise.h"
#include "points/cell_surroundings.h"
#include "points/frames_cells.h"

namespace topple::geometry {
namespace {

void drop_cells(FusedCells& fused, const std::vector<std::uint8_t>& drop) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < drop.size(); ++i) {
        if (drop[i] == 0) fused.cells[kept++] = fused.cells[i];
    }
    fused.cells.resize(kept);
}

}  // namespace

void drop_strays(FusedCells& fused, std::size_t frames, ThreadPool& pool) {
    std::vector<std::uint8_t> weak(fused.cells.size());
    visit_surroundings(fused.cells, pool, [&](std::size_t i, const Around& all) {
        const CellSums& cell = cell_at(fused.cells, i);
        const auto around = static_cast<double>(all.cells - 1),
                   count = static_cast<double>(all.count - cell.count),
                   weight = static_cast<double>(all.weight - cell.weight);
        const bool lonely = around == 0 && cell.count == 1 && frames > 1;
        // Below a tenth of its surroundings by readings and by certainty.
        const bool below = around > 0 && 10.0 * cell.count < count / around &&
                           10.0 * static_cast<double>(cell.weight) < weight / around;
        weak[i] = lonely || below;
    });
    drop_cells(fused, weak);
}

void drop_denied(FusedCells& fused, const Witnesses& witnesses, ThreadPool& pool) {
    std::vector<std::uint8_t> denied;
    for (std::size_t from = 0; from < fused.cells.size(); from += slab_cells) {
        const std::size_t n = std::min(slab_cells, fused.cells.size() - from);
        FusedPoints points;
        for (std::vector<float>* values : {&points.x, &points.y, &points.z, &points.sigma})
            values->resize(n);
        pool.each(n, fused_chunk, [&](std::size_t i) {
            const CellSums& cell = cell_at(fused.cells, from + i);
            const std::array<double, 3> at = mean_of(cell);
            constexpr auto bias = static_cast<double>(key_bias);
            points.x[i] = static_cast<float>((at[0] - bias) * fused.cell_m);
            points.y[i] = static_cast<float>((at[1] - bias) * fused.cell_m);
            points.z[i] = static_cast<float>((at[2] - bias) * fused.cell_m);
            points.sigma[i] =
                static_cast<float>(least_depth_sigma * std::sqrt(65535.0 / cell.best_weight));
        });
        const std::vector<std::uint8_t> some = witnesses.deny(points, pool);
        denied.insert(denied.end(), some.begin(), some.end());
    }
    drop_cells(fused, denied);
}

}  // namespace topple::geometry
