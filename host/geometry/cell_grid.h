// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/place.h"
#include "core/thread_pool.h"
#include "topple/cloud_view.h"

namespace topple::geometry {

// Equal keys together, by ascending key; within a group the places in `keys` ascend.
struct KeyGroups {
    std::vector<std::uint32_t> order;  // places in `keys`
    std::vector<std::uint32_t> first;  // CSR over groups, size() + 1: their parts of `order`
    std::size_t size() const { return first.size() - 1; }
    std::span<const std::uint32_t> group(std::size_t g) const {
        return std::span(order).subspan(first[g], first[g + 1] - first[g]);
    }
};
KeyGroups group_keys(std::span<const std::uint64_t> keys, ThreadPool& threads);
KeyGroups group_keys(std::span<const std::uint64_t> keys);

inline constexpr std::int64_t max_cells_per_axis = (std::int64_t{1} << 21) - 8;

// Cell indices packed so that comparing keys compares x, then y, then z, in as few bits as do.
// lowest, highest: bounds of the cells that will be packed, highest - lowest < max_cells_per_axis.
// Cells up to `reach` (3 at most) beyond the bounds can be packed too; and a key plus
// offset(dx, dy, dz) is that of the cell so far away.
using GridCell = std::array<std::int64_t, 3>;
class CellPacking {
  public:
    CellPacking(const GridCell& lowest, const GridCell& highest, int reach = 0);
    // Of the cells cell_of(0) to cell_of(count - 1); there is one at least.
    template <class CellOf>
    static CellPacking of(std::size_t count, const CellOf& cell_of, int reach = 0) {
        GridCell lowest = cell_of(0), highest = lowest;
        for (std::size_t i = 1; i < count; ++i) {
            const GridCell at = cell_of(i);
            for (std::size_t a = 0; a < 3; ++a) {
                lowest[a] = std::min(lowest[a], at[a]);
                highest[a] = std::max(highest[a], at[a]);
            }
        }
        return {lowest, highest, reach};
    }
    std::uint64_t operator()(const GridCell& at) const { return (*this)(at[0], at[1], at[2]); }
    std::uint64_t operator()(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return offset(x - lowest_[0], y - lowest_[1], z - lowest_[2]);
    }
    // Negative steps wrap around, which adding to a key undoes.
    std::uint64_t offset(std::int64_t dx, std::int64_t dy, std::int64_t dz) const {
        return (static_cast<std::uint64_t>(dx) << shift_x_) +
               (static_cast<std::uint64_t>(dy) << shift_y_) + static_cast<std::uint64_t>(dz);
    }

  private:
    GridCell lowest_{};
    int shift_x_ = 0, shift_y_ = 0;
};

// Groups of equal cells, in the order of their keys; cell_of as of CellPacking::of().
template <class CellOf>
KeyGroups group_cells(std::size_t count, const CellOf& cell_of, ThreadPool& threads) {
    constexpr std::uint64_t chunk = 1 << 13;
    const CellPacking pack = CellPacking::of(count, cell_of);
    std::vector<std::uint64_t> keys(count);
    threads.each(count, chunk, [&](std::size_t i) { keys[i] = pack(cell_of(i)); });
    return group_keys(keys, threads);
}

// Mean and covariance (xx yy zz xy xz yz) of points in a cell, in cells, from its centre.
struct CellMoments {
    std::array<float, 3> mean{};
    std::array<float, 6> spread{};
};
// The same of parts of a cell, of some weight and spread each.
struct MomentSums {
    double weight = 0;
    std::array<double, 3> first{};
    std::array<double, 6> second{};
    void add(double w, const std::array<double, 3>& at, const std::array<double, 6>& spread);
    CellMoments moments() const;
};
// Whatever the order of the points. at: the cell's index.
CellMoments moments_of(const std::array<FloatColumn, 3>& cloud,
                       std::span<const std::uint32_t> points, const Place& at, double cell_m);

// The occupied cells of a cubic grid, sorted by x, then y, then z, and the moments of what is in
// them. Lengths in cells, relative to each cell's centre, so that floats do.
struct CellGrid {
    double cell_m = 0;
    std::vector<std::int32_t> x, y, z;
    std::vector<float> weight;               // for the plane fit; 1 is an ordinary cell
    std::array<std::vector<float>, 3> mean;  // of the cell's points
    // Covariance xx yy zz xy xz yz, cells^2; empty: 0 of all.
    std::array<std::vector<float>, 6> spread;
    std::size_t size() const { return x.size(); }
    void resize(std::size_t count, bool with_spread = true);
    Place index(std::size_t cell) const { return {x[cell], y[cell], z[cell]}; }
    void set_index(std::size_t cell, const GridCell& at);
    void set(std::size_t cell, const CellMoments& moments);
};

// The grid of twice the cell size: cells merged by weight. parent: coarse cell of each fine one.
CellGrid coarsen(const CellGrid& grid, ThreadPool& threads, std::vector<std::uint32_t>& parent);

// The neighbourhood that a plane is fitted to, cells per axis to either side.
inline constexpr int plane_radius = 2;

// Neighbouring columns of sorted cells: for each cell and each (dx, dy) within the radius
// (plane_radius at most), the run of occupied cells within the radius in z.
class ColumnSweep {
  public:
    ColumnSweep(std::span<const std::int32_t> x, std::span<const std::int32_t> y,
                std::span<const std::int32_t> z, int radius);

    // Calls visit(k, column, lo, hi) for the cell cells(k), k of [first, last), and each of the
    // (2 radius + 1)^2 columns, x offset slowest: its cells within reach are [lo, hi), ascending.
    // The cells must ascend.
    template <class Cells, class Visit>
    void run(std::size_t first, std::size_t last, const Cells& cells, const Visit& visit) const;
    // The same for one column after the other, which is faster; of plane_radius alone.
    template <class Cells, class Visit>
    void run_by_column(std::size_t first, std::size_t last, const Cells& cells,
                       const Visit& visit) const;
    std::size_t columns() const { return lowest_.size(); }

  private:
    static constexpr std::size_t most_height = 2 * plane_radius + 1,
                                 most_columns = most_height * most_height;
    std::vector<std::uint64_t> keys_;    // most_height more than cells, those above all
    std::vector<std::uint64_t> lowest_;  // of each column's run, relative to the cell's key
    std::uint64_t height_ = 0;           // keys of a run
    std::size_t first_at(std::uint64_t key) const;
    std::size_t advance(std::size_t at, std::uint64_t key) const;
};

// A sweep's runs for ascending cells, a plane of cells.size() entries for each column: the first
// cell of the run, counted from `base`, + (count << 28); see kernel voxel_normals.
std::vector<std::uint32_t> column_table(const ColumnSweep& sweep,
                                        std::span<const std::uint32_t> cells, std::size_t base,
                                        ThreadPool& threads);

// CSR of the occupied cells among the 26 around each, ascending.
void cell_neighbours(std::span<const std::int32_t> x, std::span<const std::int32_t> y,
                     std::span<const std::int32_t> z, ThreadPool& threads,
                     std::vector<std::uint32_t>& first, std::vector<std::uint32_t>& neighbours);

// The first place from `at` on whose key is not below `key`; mostly a few places on.
inline std::size_t ColumnSweep::advance(std::size_t at, std::uint64_t key) const {
    for (int step = 0; step < 8; ++step, ++at) {
        if (keys_[at] >= key) return at;
    }
    std::size_t stride = 8;
    while (at + stride < keys_.size() && keys_[at + stride] < key) {
        at += stride;
        stride *= 2;
    }
    const auto begin = keys_.begin() + static_cast<std::ptrdiff_t>(at);
    const auto end =
        keys_.begin() + static_cast<std::ptrdiff_t>(std::min(at + stride, keys_.size() - 1));
    return static_cast<std::size_t>(std::lower_bound(begin, end, key) - keys_.begin());
}

template <class Cells, class Visit>
void ColumnSweep::run(std::size_t first, std::size_t last, const Cells& cells,
                      const Visit& visit) const {
    // Cells are sorted, so both ends of every run only move up; the first ones are searched for.
    std::array<std::size_t, most_columns> lo{}, hi{};
    const std::size_t columns = lowest_.size();
    if (first == last) return;
    for (std::size_t c = 0; c < columns; ++c)
        lo[c] = hi[c] = first_at(keys_[cells(first)] + lowest_[c]);
    for (std::size_t k = first; k < last; ++k) {
        const std::uint64_t key = keys_[cells(k)];
        for (std::size_t c = 0; c < columns; ++c) {
            const std::uint64_t low = key + lowest_[c];
            lo[c] = advance(lo[c], low);
            if (hi[c] < lo[c]) hi[c] = lo[c];
            while (keys_[hi[c]] < low + height_) ++hi[c];
            visit(k, c, lo[c], hi[c]);
        }
    }
}

template <class Cells, class Visit>
void ColumnSweep::run_by_column(std::size_t first, std::size_t last, const Cells& cells,
                                const Visit& visit) const {
    constexpr std::size_t height = most_height;
    if (first == last) return;
    for (std::size_t c = 0; c < lowest_.size(); ++c) {
        std::size_t lo = first_at(keys_[cells(first)] + lowest_[c]);
        for (std::size_t k = first; k < last; ++k) {
            const std::uint64_t low = keys_[cells(k)] + lowest_[c];
            lo = advance(lo, low);
            // Mostly no more cells than the run is high: counted without a branch.
            std::size_t hi = lo;
            for (std::size_t step = 0; step < height; ++step) hi += keys_[lo + step] < low + height;
            if (hi == lo + height)  // of two surfels each, perhaps
                while (keys_[hi] < low + height) ++hi;
            visit(k, c, lo, hi);
        }
    }
}

}  // namespace topple::geometry
