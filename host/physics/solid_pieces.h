// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>

#include "core/boundary_cells.h"
#include "core/solid_cells.h"

namespace topple::physics {

// What of a voxel a primitive is: its share of it, and the centre of that, metres.
struct SolidPiece {
    std::int32_t i, j, k, primitive;
    double share;
    Vec3 centre;
};

// Calls visit(piece) for all that is solid and some primitive's: first for the voxels that are its
// as a whole, then for parts of voxels, each in the order in which they are sorted.
template <class Visit>
void each_solid_piece(const SolidCells& cells, const BoundaryCells& boundary, const Visit& visit) {
    const double h = cells.voxel_m;
    const auto piece = [&](std::int32_t i, std::int32_t j, std::int32_t k, std::int32_t p,
                           double share) {
        return SolidPiece{i, j, k, p, share, {(i + 0.5) * h, (j + 0.5) * h, (k + 0.5) * h}};
    };
    std::size_t b = 0;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t p = cells.primitive[n];
        if (p < 0) continue;
        const std::tuple at(cells.i[n], cells.j[n], cells.k[n], p);
        const auto part = [&] {
            return std::tie(boundary.i[b], boundary.j[b], boundary.k[b], boundary.primitive[b]);
        };
        while (b < boundary.size() && part() < at) ++b;
        if (b < boundary.size() && part() == at) continue;  // not as a whole: below
        visit(piece(cells.i[n], cells.j[n], cells.k[n], p, 1));
    }
    for (b = 0; b < boundary.size(); ++b) {
        if (boundary.share[b] == 0) continue;
        const auto share = static_cast<double>(boundary.share[b]);
        SolidPiece part = piece(boundary.i[b], boundary.j[b], boundary.k[b], boundary.primitive[b],
                                share / BoundaryCells::whole);
        for (std::size_t a = 0; a < 3; ++a) part.centre[a] += h / 4 * boundary.moment[a][b] / share;
        visit(part);
    }
}

}  // namespace topple::physics
