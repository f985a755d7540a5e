// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "device/stage_clock.h"
#include "scale/blocks.h"
#include "solids/solid_parts.h"

namespace topple {

// Primitive of the whole scene for each one of each block; -1 where nothing of it is left.
using BlockNumbers = std::vector<std::vector<std::int32_t>>;

struct JoinedBlocks {
    SolidParts parts;  // without its points
    BlockNumbers number;
};

// Joins the primitives of neighbouring blocks. Around the border of two cores both have seen the
// same surface: primitives of which each is the one that shares most voxels with the other there
// are one, if these are at least half of the smaller one's. Every voxel is taken from the block
// whose core it is in. Primitives are numbered by their first block, and within it in its order.
JoinedBlocks join_blocks(const std::filesystem::path& folder, const tiles::Layout& layout,
                         StageClock& stage);

}  // namespace topple
