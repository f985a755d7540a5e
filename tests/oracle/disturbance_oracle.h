// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

// The disturbance field in plain double precision, on a plain 2D grid, and the other way round than
// the kernels disturbance and disturbance_reach: each walker scatters to the cells that a part
// reaches.
namespace topple::oracle {

struct Grid {
    int nx = 0, ny = 0;
    std::vector<std::uint32_t> solid;  // ny x nx: bit b: a solid crosses band b
    std::uint32_t at(int x, int y) const {
        return x < 0 || y < 0 || x >= nx || y >= ny ? 0u
                                                    : solid[static_cast<std::size_t>(y) * nx + x];
    }
};

// Bands that are shut on the straight line between two cells, both excluded; a diagonal move is
// shut where both cells beside it are. The line is followed from the reached cell, as halves round
// away from it.
inline std::uint32_t shut_between(const Grid& grid, int x, int y, int walker_x, int walker_y) {
    const int n = std::max(std::abs(walker_x - x), std::abs(walker_y - y));
    std::uint32_t shut = 0;
    int px = x, py = y;
    for (int s = 1; s <= n; ++s) {
        // std::round takes halves away from 0.
        const int cx = x + static_cast<int>(std::round(double(walker_x - x) * s / n));
        const int cy = y + static_cast<int>(std::round(double(walker_y - y) * s / n));
        if (cx != px && cy != py) shut |= grid.at(cx, py) & grid.at(px, cy);
        if (s < n) shut |= grid.at(cx, cy);
        px = cx;
        py = cy;
    }
    return shut;
}

// weight(ahead, aside): of a place in the walker's own axes, in cells. Returns ny x nx densities of
// one band and direction (unit vector dx, dy); primary: ny x nx walks per event.
template <class Weight>
std::vector<double> scatter(const Grid& grid, const std::vector<double>& primary, unsigned band,
                            double dx, double dy, int radius, Weight weight) {
    std::vector<double> density(primary.size(), 0.0);
    for (int wy = 0; wy < grid.ny; ++wy) {
        for (int wx = 0; wx < grid.nx; ++wx) {
            const double walks = primary[static_cast<std::size_t>(wy) * grid.nx + wx];
            if (walks == 0) continue;
            for (int y = std::max(0, wy - radius); y <= std::min(grid.ny - 1, wy + radius); ++y) {
                for (int x = std::max(0, wx - radius); x <= std::min(grid.nx - 1, wx + radius);
                     ++x) {
                    const double ahead = (x - wx) * dx + (y - wy) * dy;
                    const double aside = std::fabs((x - wx) * dy - (y - wy) * dx);
                    const double w = weight(ahead, aside);
                    if (w <= 0 || (shut_between(grid, x, y, wx, wy) >> band & 1u)) continue;
                    density[static_cast<std::size_t>(y) * grid.nx + x] += w * walks;
                }
            }
        }
    }
    return density;
}

// What the kernel `disturbance` computes for one cell, direction and band.
struct Entry {
    int delta;
    std::uint32_t row;
    float weight;
};
inline double gather(const std::vector<Entry>& entries, const std::vector<float>& primary,
                     std::size_t map_cell, const std::vector<std::uint32_t>& blocked,
                     std::size_t rows, std::size_t cell, unsigned band) {
    double sum = 0;
    for (const Entry& e : entries) {
        if (blocked[(cell / 64 * rows + e.row) * 64 + cell % 64] >> band & 1u) continue;
        sum += double{e.weight} * double{primary[map_cell + static_cast<std::size_t>(e.delta)]};
    }
    return sum;
}

}  // namespace topple::oracle
