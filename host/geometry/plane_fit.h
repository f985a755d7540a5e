// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "device/device.h"
#include "geometry/cell_grid.h"

namespace topple::geometry {

// Points to fit a plane at: each in its cell of a grid, positions in cells from the cell's centre.
struct PlaneQueries {
    std::vector<std::uint32_t> cell;
    std::array<std::vector<float>, 3> at;
};

// The planes found, one per query.
struct PlaneFit {
    std::array<std::vector<float>, 3> normal;  // unit, sign arbitrary; 0 where undefined
    std::vector<float> rms;                    // of the neighbourhood about the plane, cells
    std::vector<float> offset;  // from the query to the plane along the normal, cells
    std::vector<float> used;    // cells that took part
};

// Oriented normals of the grid's cells from an earlier fit, or empty: see kernel voxel_normals.
struct PlanePrior {
    std::span<const float> x, y, z;
};

// A query at the mean of each cell.
PlaneQueries queries_at_means(const CellGrid& grid);

// Fits planes to the neighbourhoods of one grid, which must outlive the fitter: what kernel
// voxel_normals needs of it is made once. The grid goes in tiles where it is larger than a binding
// may be; then only the last one is kept.
class PlaneFitter {
  public:
    // radius: of the neighbourhood, cells per axis, 1 to 3. Throws Error(device) where not even one
    // layer of cells fits a binding.
    PlaneFitter(device::Device& device, const CellGrid& grid, int radius = default_radius);
    ~PlaneFitter();
    PlaneFit fit(const PlaneQueries& queries, const PlanePrior& prior);

    static constexpr int default_radius = 2;

    // The cells [first, last) that a tile answers for, and [halo_first, halo_last) that it looks
    // at.
    struct Tile {
        std::size_t first, last, halo_first, halo_last;
    };

  private:
    struct OnDevice;
    const OnDevice& prepare(const Tile& tile);
    // Fits the queries in `order`, whose cells lie in the tile.
    void fit_tile(const Tile& tile, const PlaneQueries& queries, const PlanePrior& prior,
                  std::span<const std::uint32_t> order, PlaneFit& fit);

    device::Device& device_;
    const CellGrid& grid_;
    int radius_;
    ColumnSweep sweep_;
    std::vector<Tile> tiles_;
    const Tile* prepared_tile_ = nullptr;
    std::unique_ptr<OnDevice> prepared_;
};

// The same for one fit.
PlaneFit fit_planes(device::Device& device, const CellGrid& grid, const PlaneQueries& queries);

}  // namespace topple::geometry
