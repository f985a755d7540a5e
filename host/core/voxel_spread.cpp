// SPDX-License-Identifier: MIT
#include "core/voxel_spread.h"

namespace topple {

bool VoxelSpread::add(std::int32_t i, std::int32_t j, std::int32_t k) {
    // Differences of such places, and those of their neighbours, are no overflow.
    constexpr std::int32_t farthest = 1 << 30;
    for (const std::int32_t x : {i, j, k})
        if (x <= -farthest || x >= farthest) return false;
    ++voxels_;
    for (Level& level : levels_) {
        const Block block{i >> level.shift, j >> level.shift, k >> level.shift};
        if (block == level.last && !level.blocks.empty()) continue;
        level.last = block;
        level.blocks.insert(block);
        if (level.blocks.size() > level.few + voxels_ / level.each) return false;
    }
    return true;
}

}  // namespace topple
