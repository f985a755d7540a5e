// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace topple::geometry {

// The order that sorts keys ascending; equal keys keep their order. Radix sort over the bytes in
// use.
std::vector<std::uint32_t> sorted_order(std::span<const std::uint64_t> keys);

// Cell indices packed so that comparing keys compares x, then y, then z. `lowest` is the lowest
// index per axis of the cells that will be packed; indices may lie up to 2^21 - 1 above it.
struct CellPacking {
    std::array<std::int32_t, 3> lowest{};
    std::uint64_t operator()(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return static_cast<std::uint64_t>(x - lowest[0]) << 42 |
               static_cast<std::uint64_t>(y - lowest[1]) << 21 |
               static_cast<std::uint64_t>(z - lowest[2]);
    }
};
inline constexpr std::int64_t max_cells_per_axis = std::int64_t{1} << 21;

// The occupied cells of a cubic grid, sorted by x, then y, then z, and the moments of what is in
// them. Lengths in cells, relative to each cell's centre, so that floats do.
struct CellGrid {
    double cell_m = 0;
    std::vector<std::int32_t> x, y, z;
    std::vector<float> weight;                 // for the plane fit; 1 is an ordinary cell
    std::array<std::vector<float>, 3> mean;    // of the cell's points
    std::array<std::vector<float>, 6> spread;  // covariance xx yy zz xy xz yz, cells^2
    std::size_t size() const { return x.size(); }
    void resize(std::size_t count);
};

// The grid of twice the cell size: cells merged by weight. parent: coarse cell of each fine one.
CellGrid coarsen(const CellGrid& grid, std::vector<std::uint32_t>& parent);

// For the cells [first, last): where the occupied cells of each neighbouring column start and how
// many lie within `radius` in z; (2 radius + 1)^2 planes of last - first, x offset slowest. An
// entry is the first cell + (count << 29); see kernel voxel_normals.
std::vector<std::uint32_t> column_table(const CellGrid& grid, int radius, std::size_t first,
                                        std::size_t last, std::size_t base);

// CSR of the occupied cells among the 26 around each, ascending.
void cell_neighbours(std::span<const std::int32_t> x, std::span<const std::int32_t> y,
                     std::span<const std::int32_t> z, std::vector<std::uint32_t>& first,
                     std::vector<std::uint32_t>& neighbours);

}  // namespace topple::geometry
