// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <vector>

#include "core/field_rules.h"
#include "core/place.h"
#include "geometry/manhattan.h"
#include "scale/thinned_bin.h"

namespace topple::tiles {

using Voxel = Place;

// A box of voxels in the grid frame: [low, high) per axis.
struct VoxelBox {
    Voxel low{}, high{};
    bool holds(const Voxel& at) const {
        for (std::size_t a = 0; a < 3; ++a)
            if (at[a] < low[a] || at[a] >= high[a]) return false;
        return true;
    }
    bool empty() const { return low[0] >= high[0] || low[1] >= high[1] || low[2] >= high[2]; }
    VoxelBox common(const VoxelBox& other) const {
        VoxelBox out;
        for (std::size_t a = 0; a < 3; ++a) {
            out.low[a] = std::max(low[a], other.low[a]);
            out.high[a] = std::min(high[a], other.high[a]);
        }
        return out;
    }
    VoxelBox grown(std::int32_t by) const {
        VoxelBox out = *this;
        for (std::size_t a = 0; a < 3; ++a) out.low[a] -= by, out.high[a] += by;
        return out;
    }
};

// Of what a file says of voxels: a rule (core/field_rules.h) that leaves room for halos.
inline constexpr auto voxels = rules::within(-(1 << 27), 1 << 27);

// Part of a storey that is looked at in one piece. Each voxel is in the core of one block; around
// its core a block sees `Layout::halo` voxels more, but nothing of the floor above.
struct Block {
    VoxelBox core, seen;
    double floor_m = 0;       // of its storey, NaN where that has none
    double top_m = 0;         // where the next storey begins; infinite above the last
    std::uint64_t cells = 0;  // thinned cells in its core
};

// How a cloud is cut, and what all blocks have in common. Depends on the cloud and the options
// alone.
struct Layout {
    double cell_m = 0, voxel_m = 0;
    std::int32_t halo = 0;  // voxels
    geometry::SceneFrame frame;
    std::vector<Block> blocks;  // by (storey, i, j)

    // That in which a point of the input's frame lies.
    Voxel voxel_at(float x, float y, float z) const {
        Voxel at{};
        for (std::size_t a = 0; a < 3; ++a) {
            const Vec3& axis = frame.axes[a];
            at[a] = static_cast<std::int32_t>(
                std::floor((axis[0] * x + axis[1] * y + axis[2] * z) / voxel_m));
        }
        return at;
    }
};

inline std::uint64_t largest_block(const Layout& layout) {
    std::uint64_t cells = 0;
    for (const Block& b : layout.blocks) cells = std::max(cells, b.cells);
    return cells;
}

// Edge of blocks, rounded to whole leaves of 8 voxels, and what they see beyond it, metres. A halo
// is wider than what the stages up to filling look around for, and than most parts of furniture.
inline constexpr double block_edge_m = 5, halo_m = 0.8;

// Cuts the thinned bins of `folder`. Blocks lie at multiples of their edge, whatever the cloud's
// extent.
Layout cut_into_blocks(const std::filesystem::path& folder, std::span<const Bin> bins,
                       const geometry::SceneFrame& frame, double cell_m, double voxel_m);

// The blocks of a layout, as many together as lie in a square of a storey with edges of tile_m,
// rounded to whole blocks: they are handed out, and read, together. Each block is in one tile.
std::vector<std::vector<std::size_t>> tiles_of(const Layout& layout, double tile_m);

inline constexpr const char* layout_name = "layout.bin";
void write_layout(const std::filesystem::path& folder, const Layout& layout);
Layout read_layout(const std::filesystem::path& folder);

// The thinned points that a block sees, and which of their bins' cells they are.
struct BlockPoints {
    PointCloud cloud;
    struct Part {
        std::size_t bin = 0;                // index into the bins
        std::vector<std::uint32_t> cells;   // ascending; of the next cells.size() points
        std::vector<std::uint8_t> in_core;  // of the same points
    };
    std::vector<Part> parts;
};

// Gives the points of the blocks of a tile, in the tile's order. Reads each bin once, and holds it
// until the last block that sees some of it.
class TileReader {
  public:
    // blocks: of the layout, those of the tile. What is referred to must outlive the reader.
    TileReader(const std::filesystem::path& folder, std::span<const Bin> bins, const Layout& layout,
               std::span<const std::size_t> blocks);
    // Of the next block; called once for each.
    BlockPoints next();

  private:
    bool sees(std::size_t block, std::size_t bin) const;

    const std::filesystem::path& folder_;
    std::span<const Bin> bins_;
    const Layout& layout_;
    std::span<const std::size_t> blocks_;
    std::map<std::size_t, ThinnedBin> held_;  // by index of the bin
    std::size_t next_ = 0;
};

}  // namespace topple::tiles
