// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/frames_fusion.h"
#include "geometry/frames_witnesses.h"

namespace topple::geometry {

// What the readings in one cell sum up to. Integers, so that the sums do not depend on the order in
// which threads or frames arrive. Offsets are 1 / 65536 of a cell from its lowest corner.
struct CellSums {
    std::uint64_t key = 0;
    std::array<std::uint64_t, 3> offset{};  // sum of weight * offset
    std::uint64_t weight = 0;       // sum of inverse variances, in 65535ths of the best reading's
    std::uint32_t count = 0;        // readings
    std::uint32_t best_weight = 0;  // of the best reading,
    std::uint32_t best_frame = 0;   // and its frame, the first of equals
    // Of the readings whose colour is known: weight * channel, with weights of 8 bits, and those
    // weights. What would not fit is left out: the mean of 65,000 good readings is known by then.
    std::array<std::uint32_t, 3> colour{};
    std::uint32_t colour_weight = 0;
    void add(const CellSums& other);
    void add_colour(const std::array<std::uint32_t, 3>& sums, std::uint32_t weights);
};

inline constexpr std::int64_t key_bias = std::int64_t{1} << 20;

// Occupied cells and their sums, found through blocks of 4 x 4 x 4 cells: the readings of a frame
// stay within few blocks for long, so that most lookups touch memory just touched.
class CellTable {
  public:
    struct Block {
        std::uint64_t key = 0;
        std::uint32_t count = 0;             // of occupied cells
        std::array<std::uint32_t, 64> at{};  // by cell, z fastest: place in cells() + 1, or 0
    };
    static std::uint64_t block_of(std::uint64_t key) { return key >> 2 & block_mask; }
    void add(std::span<const CellSums> sums, std::span<const std::uint32_t> which);
    const std::vector<CellSums>& cells() const { return cells_; }
    const std::vector<Block>& blocks() const { return blocks_; }

  private:
    // The upper 19 of the 21 bits of each axis, where they lie in a key shifted by 2.
    static constexpr std::uint64_t block_mask = 0x7FFFFu * (1 + (1ull << 21) + (1ull << 42));
    static std::uint64_t hash(std::uint64_t key) { return key * 0x9E3779B97F4A7C15u >> 20; }
    std::size_t find(std::uint64_t key);  // the block's place, new where there was none
    void grow();
    std::vector<std::uint32_t> slots_;  // open addressing: place in blocks_ + 1, or 0
    std::vector<Block> blocks_;
    std::vector<CellSums> cells_;
    std::size_t last_ = 0;  // the block found last
};

// Cells shared out over tables by cubes of 32 cells, so that several threads may fill them, one per
// table, and that neighbours are near one another in memory.
struct CellTables {
    // So many that the part of a table that a batch of sums meets stays in a core's cache.
    static constexpr std::size_t shard_count = 256;
    static std::size_t shard_of(std::uint64_t key) {
        constexpr std::uint64_t cube_mask = 0xFFFFu * (1 + (1ull << 21) + (1ull << 42));
        return (key >> 5 & cube_mask) * 0xD6E8FEB86659FD93u >> 56;
    }
    std::array<CellTable, shard_count> shards;
    // In order, whatever the number of threads.
    void add(std::span<const std::span<const CellSums>> parts, ThreadPool& pool);
    // All cells by ascending key.
    std::vector<CellSums> sorted(ThreadPool& pool) const;
};

// What depends on a reading's depth alone.
struct DepthReading {
    float largest_jump = 0;  // to a neighbour on one surface, as stored
    std::uint32_t weight = 0;
};

struct FrameFusion::Cells {
    static constexpr std::size_t block_count = 16;
    Cells(const Intrinsics& intrinsics, unsigned threads) : pool(threads), witnesses(intrinsics) {}
    ThreadPool pool;
    CellTables tables;
    Witnesses witnesses;
    // Per block of image rows: runs of readings in one cell.
    std::array<std::vector<CellSums>, block_count> runs;
    void flush();  // runs to the tables
    std::vector<Vec3> viewpoints;
    std::array<std::uint64_t, block_count> outside{};  // readings beyond the grid's reach
    std::vector<DepthReading> by_depth;                // as stored
    std::vector<double> columns;                       // of pixels: the ray's slope
};

// Fused cells to clean: sorted by key.
struct FusedCells {
    double cell_m = 0;
    std::vector<CellSums> cells;
};
// Drops cells of stray readings.
void drop_weak(FusedCells& fused, std::size_t frames, ThreadPool& pool);
// Drops cells that the frames deny.
void drop_denied(FusedCells& fused, const Witnesses& witnesses, ThreadPool& pool);
// One step of moving least squares, then bins anew: readings spread to both sides of a surface by
// their noise become one layer. Cells whose readings spread by less than least_sigma_m stay.
void flatten_layers(FusedCells& fused, double least_sigma_m, ThreadPool& pool);

}  // namespace topple::geometry
