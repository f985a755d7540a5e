// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "device/native/thread_pool.h"
#include "geometry/frames_fusion.h"

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
    void add(const CellSums& other);
};

inline constexpr std::int64_t key_bias = std::int64_t{1} << 20;

// Open-addressing table from cells to their sums.
class CellTable {
  public:
    void add(const CellSums& sums);
    const std::vector<CellSums>& cells() const { return cells_; }

  private:
    void grow();
    static std::uint64_t hash(std::uint64_t key) { return key * 0x9E3779B97F4A7C15u >> 20; }
    struct Slot {
        std::uint64_t key = 0;
        std::uint32_t at = 0;  // cell + 1, 0 for an empty slot
    };
    std::vector<Slot> slots_;
    std::vector<CellSums> cells_;
};

// Cells share out over shards by key; each shard has one writer at a time.
struct FrameFusion::Cells {
    static constexpr std::size_t shard_count = 16, block_count = 16;
    device::ThreadPool pool{0};
    std::array<CellTable, shard_count> shards;
    // Per block of image rows and shard: runs of readings in one cell.
    std::array<std::array<std::vector<CellSums>, shard_count>, block_count> runs;
    std::vector<Vec3> viewpoints;
    std::array<std::uint64_t, block_count> outside{};  // readings beyond the grid's reach
    std::vector<float> sigma_limit;     // by stored depth: largest jump on one surface
    std::vector<std::uint32_t> weight;  // by stored depth
};

// Fused cells to clean: sorted by key.
struct FusedCells {
    double cell_m = 0;
    std::vector<CellSums> cells;
};
// Drops cells of stray readings.
void drop_weak(FusedCells& fused, std::size_t frames);
// One step of moving least squares, then bins anew; see flatten_noise.
void flatten_layers(FusedCells& fused);

}  // namespace topple::geometry
