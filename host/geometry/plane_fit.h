// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/cell_grid.h"
#include "topple/kernels/device.h"

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

    std::size_t size() const { return rms.size(); }
    bool has_plane(std::size_t q) const {
        return normal[0][q] != 0 || normal[1][q] != 0 || normal[2][q] != 0;
    }
    // The arrays, in this order.
    std::array<std::vector<float>*, 6> columns() {
        return {&normal[0], &normal[1], &normal[2], &rms, &offset, &used};
    }
    void resize(std::size_t count) {
        for (std::vector<float>* column : columns()) column->resize(count);
    }
};

// Oriented normals of the grid's cells from an earlier fit, or empty: see kernel voxel_normals.
struct PlanePrior {
    std::span<const float> x, y, z;
};

// A query at the mean of each cell.
PlaneQueries queries_at_means(const CellGrid& grid);

// Fits planes to neighbourhoods in one grid, which must outlive the fitter: what kernel
// voxel_normals needs of grid and queries is made once. They go in tiles where there is more of
// them than fits a binding or some 200 MB; then only the last one is kept.
class PlaneFitter {
  public:
    // Throws Error(device) where not even one layer of cells fits a binding.
    PlaneFitter(device::Device& device, const CellGrid& grid, PlaneQueries queries);
    ~PlaneFitter();
    PlaneFit fit(const PlanePrior& prior);
    // From each query along its normal to the surface, in cells (kernel plane_mean). The plane that
    // is fitted to a neighbourhood of a curved surface lies inside of it by b = mean(r^2) / 2 R,
    // parallel to its tangent plane; and r away from there by b - r^2 / 2 R. So what all planes of
    // a neighbourhood say, on average by the same weights as they were fitted with, is right to
    // second order, while one alone shrinks what is round. Planes that face elsewhere don't count.
    // fit: of these queries, of which no two may be in one cell.
    std::vector<float> mean_offsets(const PlaneFit& fit);

  private:
    // The queries [first, last) by ascending cell, and the cells [halo_first, halo_last) that they
    // look at.
    struct Tile {
        std::size_t first, last, halo_first, halo_last;
    };
    struct OnDevice;
    std::vector<Tile> make_tiles() const;
    const OnDevice& prepare(const Tile& tile);
    void fit_tile(const Tile& tile, const PlanePrior& prior, PlaneFit& fit);
    void mean_tile(const Tile& tile, std::span<const std::uint32_t> query_of, const PlaneFit& fit,
                   std::vector<float>& out);

    device::Device& device_;
    const CellGrid& grid_;
    PlaneQueries queries_;
    std::vector<std::uint32_t> order_;  // of the queries, by ascending cell
    std::vector<std::uint32_t> cell_;   // of each in that order
    ColumnSweep sweep_;
    std::vector<Tile> tiles_;
    const Tile* prepared_tile_ = nullptr;
    std::unique_ptr<OnDevice> prepared_;
};

// The same for one fit.
PlaneFit fit_planes(device::Device& device, const CellGrid& grid, PlaneQueries queries);

}  // namespace topple::geometry
