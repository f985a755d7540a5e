// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <boost/container/deque.hpp>
#include <boost/container/options.hpp>
#include <boost/container/vector.hpp>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/back_projection.h"
#include "points/frames_fusion.h"
#include "points/frames_witnesses.h"

namespace topple::geometry {

// A cell's key holds 21 bits of each axis' index, so that keys ascend by x, then y, then z.
inline constexpr std::array<unsigned, 3> key_shift{42, 21, 0};
inline constexpr std::uint64_t key_mask = 0x1FFFFF;
inline std::uint64_t key_of(const std::array<std::uint64_t, 3>& index) {
    return index[0] << key_shift[0] | index[1] << key_shift[1] | index[2] << key_shift[2];
}
// From the grid's lowest corner.
inline std::int64_t index_in(std::uint64_t key, std::size_t axis) {
    return static_cast<std::int64_t>(key >> key_shift[axis] & key_mask);
}

// What the readings in one cell sum up to. Integers, so that the sums do not depend on the order in
// which threads or frames arrive. Offsets are 1 / 65536 of a cell from its lowest corner.
// Not initialised by itself, so that millions of them may be made where each is written. A cache
// line: they lie scattered where readings are added to them.
struct alignas(64) CellSums {
    std::uint64_t key;
    std::array<std::uint64_t, 3> offset;  // sum of weight * offset
    std::uint64_t weight : 48;       // sum of inverse variances, in 65535ths of the best reading's
    std::uint64_t best_weight : 16;  // of the best reading here,
    std::uint32_t best_frame;        // and its frame, the first of equals
    std::uint32_t count;             // readings
    // Of the readings whose colour is known: weight * channel, with weights of 8 bits, and those
    // weights. What would not fit is left out: the mean of 65,000 good readings is known by then.
    std::array<std::uint32_t, 3> colour;
    std::uint32_t colour_weight;
    void add(const CellSums& other);
    // A reading of the frame best_frame at `part`, 65536ths of the cell from its lowest corner.
    void add(std::uint32_t reading_weight, const std::array<std::uint32_t, 3>& part);
    void add_colour(const std::array<std::uint32_t, 3>& sums, std::uint32_t weights);
};
static_assert(sizeof(CellSums) == 64);

inline void CellSums::add(std::uint32_t reading_weight, const std::array<std::uint32_t, 3>& part) {
    for (std::size_t a = 0; a < 3; ++a) offset[a] += std::uint64_t{reading_weight} * part[a];
    weight += reading_weight;
    if (reading_weight > best_weight) best_weight = reading_weight;
    ++count;
}

// Of a cell's readings along one axis, in cell_parts from its lowest corner.
inline double mean_offset(const CellSums& cell, std::size_t axis) {
    return static_cast<double>(cell.offset[axis]) / static_cast<double>(cell.weight);
}

// Occupied cells and their sums, found through cubes of 8 x 8 x 8 blocks of 4 x 4 x 4 cells: the
// readings of a frame stay within few of them for long, so that most lookups touch memory just
// touched.
class CellTable {
  public:
    // Grows without a copy, which would take as much memory once more.
    template <class T>
    using Grown = boost::container::deque<
        T, std::allocator<T>,
        typename boost::container::deque_options<boost::container::block_size<256U>>::type>;
    struct Block {
        std::uint64_t key = 0;
        std::uint32_t count = 0;             // of occupied cells
        std::array<std::uint32_t, 64> at{};  // by cell, z fastest: place in cells() + 1, or 0
    };
    // Where the cube lies that a cell is in: the upper 16 of the 21 bits of each axis, where they
    // lie in a key shifted by 5.
    static std::uint64_t cube_of(std::uint64_t key) {
        return key >> 5 & 0xFFFFu * (1 + (1ull << 21) + (1ull << 42));
    }
    // sums: of `which`, by place, the sum there.
    template <class Sums>
    void add(const Sums& sums, std::span<const std::uint32_t> which);
    Grown<CellSums>& cells() { return cells_; }
    const Grown<Block>& blocks() const { return blocks_; }
    // That it holds, and that cleaning its cells takes besides.
    std::size_t bytes() const;
    // Leaves the cells alone: none is found any more.
    void drop_index();

  private:
    struct Cube {
        std::uint64_t key = 0;
        std::array<std::uint32_t, 512> at{};  // by block, z fastest: place in blocks() + 1, or 0
    };
    // The upper 19 of the 21 bits of each axis, where they lie in a key shifted by 2.
    static std::uint64_t block_of(std::uint64_t key) {
        return key >> 2 & 0x7FFFFu * (1 + (1ull << 21) + (1ull << 42));
    }
    static std::uint64_t hash(std::uint64_t key) { return key * 0x9E3779B97F4A7C15u >> 20; }
    Cube& cube(std::uint64_t key);
    // The cell's block, and the cell's place in cells(), with no readings where there was none.
    Block& block(std::uint64_t key);
    std::uint32_t place_of(std::uint64_t key);
    void grow();
    std::vector<std::uint32_t> slots_;  // open addressing: place in cubes_ + 1, or 0
    std::vector<Cube> cubes_;
    Grown<Block> blocks_;
    Grown<CellSums> cells_;
    std::size_t last_ = 0;  // the cube found last
};

// Where cells lie in their tables.
using CellPlaces = boost::container::vector<CellSums*>;
// One of them, for loops over many: they lie scattered, so that those some way on are fetched.
inline constexpr std::size_t cells_ahead = 16;
template <class Places>
auto& cell_at(const Places& cells, std::size_t i) {
    if (i + cells_ahead < cells.size()) __builtin_prefetch(cells[i + cells_ahead]);
    return *cells[i];
}

// Cells shared out over tables by their cubes, so that several threads may fill them, one per
// table, and that neighbours are near one another in memory.
struct CellTables {
    // So many that the part of a table that a batch of sums meets stays in a core's cache.
    static constexpr std::size_t shard_count = 256;
    static std::size_t shard_of(std::uint64_t key) {
        return CellTable::cube_of(key) * 0xD6E8FEB86659FD93u >> 56;
    }
    std::array<CellTable, shard_count> shards;
    // In order, whatever the number of threads. Ends early where they come to hold more than
    // most_bytes.
    void add(std::span<const std::span<const CellSums>> parts, ThreadPool& pool,
             std::size_t most_bytes = SIZE_MAX);
    void add(std::span<const std::span<CellSums* const>> parts, ThreadPool& pool);
    // All cells by ascending key; as long as nothing is added.
    CellPlaces sorted(ThreadPool& pool);
    std::size_t bytes() const;
};

// Sums up readings of neighbouring pixels that lie in one cell, so that tables are asked for each
// few of them once.
class NeighbourSums {
  public:
    explicit NeighbourSums(std::size_t width) : above_(width) {}
    // The next row of a frame: appends to `sums`, and counts the readings beyond the grid's reach.
    // rgb: of its pixels, or null.
    void add(const RowReadings& row, const std::uint8_t* rgb, std::uint32_t frame,
             std::vector<CellSums>& sums, std::uint64_t& outside);

  private:
    // The cell that a pixel's reading lies in, and its place among the sums. No key is 0.
    struct Home {
        std::uint64_t key = 0;
        std::size_t at = 0;
    };
    std::vector<Home> above_;  // of the row before
};

struct FrameFusion::Cells {
    static constexpr std::size_t block_count = 16;  // of image rows
    Cells(const Intrinsics& intrinsics, double cell_m, unsigned threads)
        : pool(threads), projection(intrinsics, cell_m), witnesses(intrinsics) {}
    ThreadPool pool;
    BackProjection projection;
    CellTables tables;
    Witnesses witnesses;
    std::array<std::vector<CellSums>, block_count> waiting;
    void flush();  // what waits to the tables, unless they come to hold more than most_bytes
    std::size_t most_bytes = SIZE_MAX;
    std::vector<Vec3> viewpoints;
    std::array<std::uint64_t, block_count> outside{};  // readings beyond the grid's reach
};

// Fused cells to clean, where they lie: a copy of millions of them would be most of the memory that
// a parse takes.
struct FusedCells {
    FusedCells(CellTables tables, double cell_m, ThreadPool& pool);
    double cell_m;
    CellTables tables;  // without their index
    CellPlaces cells;   // those that are left, sorted by key
};
// Where a cell's mean lies, in cells from the grid's lowest corner.
std::array<double, 3> mean_of(const CellSums& cell);

// Cells handed to a thread at once; and those that a step works on at once, along x: tables of all
// of a scan's would be most of the memory that a parse takes.
inline constexpr std::uint64_t fused_chunk = 1 << 15;
inline constexpr std::size_t slab_cells = std::size_t{1} << 18;

// Drops stray readings, of so many frames.
void drop_strays(FusedCells& fused, std::size_t frames, ThreadPool& pool);
// Drops cells that the frames deny.
void drop_denied(FusedCells& fused, const Witnesses& witnesses, ThreadPool& pool);
// One step of moving least squares, then bins anew: readings spread to both sides of a surface by
// their noise become one layer. Cells whose readings spread by less than least_sigma_m stay.
void flatten_layers(FusedCells& fused, double least_sigma_m, ThreadPool& pool);

}  // namespace topple::geometry
