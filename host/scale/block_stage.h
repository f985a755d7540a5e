// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/role.h"
#include "core/solid_cells.h"
#include "device/stage_clock.h"
#include "geometry/surface_samples.h"
#include "geometry/surface_seams.h"
#include "scale/blocks.h"
#include "topple/kernels/device.h"

// Section 2 of the paper for one block of a cloud that is larger than memory.
namespace topple {

// What a block says of the scene. Primitives are the block's own.
struct BlockParts {
    struct Primitive {
        char model = 'p';  // 'p' plane, 'q' quadric, 'm' merged
        Role role = Role::none;
        float shell_log_odds = 0;
    };
    std::vector<Primitive> primitives;
    SolidCells cells;              // of core and halo, grid frame
    geometry::SurfaceSeams seams;  // of the surface in the core, as the samples
    geometry::SurfaceSamples samples;
    // The leaves of the core that are not all invisible: lowest voxels, three numbers each, and
    // their voxels' states, 512 each, or none where the leaf is all empty.
    std::vector<std::int32_t> empty_leaves, leaves;
    std::vector<std::uint8_t> states;
    // Primitive of each thinned point of the core, -1 for none: by bin (an index into the bins),
    // cells of it.
    struct Labels {
        std::uint64_t bin = 0;
        std::vector<std::uint32_t> cells;
        std::vector<std::int32_t> primitive;
    };
    std::vector<Labels> labels;
};

// Grid frame. A block without a surface has no primitives.
BlockParts parse_block(device::Device& device, const tiles::BlockPoints& points,
                       const tiles::Layout& layout, const tiles::Block& block,
                       const ParseOptions& options);

std::filesystem::path block_file(const std::filesystem::path& folder, std::size_t block);
void write_block(const std::filesystem::path& folder, std::size_t block, const BlockParts& parts);
BlockParts read_block(const std::filesystem::path& folder, std::size_t block);

}  // namespace topple
