// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>

#include "standard.h"

namespace topple::oracle {

// A cell whose plane is known: {x | normal . (x - query) = offset}, lengths in cells.
struct FittedCell {
    std::array<int, 3> index{};
    double weight = 0;                                // 0: it has no plane
    Eigen::Vector3d query = Eigen::Vector3d::Zero();  // from the cell's centre
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double offset = 0;
};

struct PlaneMean {
    double offset = 0;
    double scale = 0;     // largest of what was averaged
    double verge = 1e30;  // how near a cell is to being counted otherwise
};

// Kernel plane_mean in plain double precision: all cells are tried.
inline PlaneMean plane_mean(const std::vector<FittedCell>& cells, std::size_t home, int radius,
                            double least_cosine) {
    const FittedCell& me = cells[home];
    PlaneMean out;
    double total = 0, sum = 0;
    for (const FittedCell& cell : cells) {
        const Eigen::Vector3d step(cell.index[0] - me.index[0], cell.index[1] - me.index[1],
                                   cell.index[2] - me.index[2]);
        if (cell.weight == 0 || step.cwiseAbs().maxCoeff() > radius) continue;
        const Eigen::Vector3d way = step + cell.query - me.query;
        const double reach = radius + 0.5, cosine = cell.normal.dot(me.normal);
        const double taper = 1 - way.squaredNorm() / (reach * reach);
        if (taper <= 0) continue;
        out.verge = std::min(out.verge, std::abs(std::abs(cosine) - least_cosine));
        if (std::abs(cosine) < least_cosine) continue;
        const double weight = cell.weight * taper * taper;
        // The plane's distance from my query along its normal, turned to my side.
        const double says = (cell.offset + cell.normal.dot(way)) * (cosine < 0 ? -1 : 1);
        total += weight;
        sum += weight * says;
        out.scale = std::max(out.scale, std::abs(cell.offset) + way.norm());
    }
    out.offset = total > 0 ? sum / total : me.offset;
    return out;
}

}  // namespace topple::oracle
