// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <set>

namespace topple {

// Whether voxels that a file names lie together, as a scene's do. Maps and trees of voxels are made
// of blocks, each of which takes memory by itself: of voxels strewn by a file's word a few bytes of
// it would take megabytes.
class VoxelSpread {
  public:
    // Whether it may be one of them, after those before it.
    bool add(std::int32_t i, std::int32_t j, std::int32_t k);

  private:
    using Block = std::array<std::int32_t, 3>;
    // Blocks with edges of 2^shift voxels: `few` at least may be there, and one more for each
    // `each` voxels.
    struct Level {
        int shift;
        std::uint64_t few, each;
        Block last{};
        std::set<Block> blocks{};
    };
    std::array<Level, 2> levels_{{{7, 1024, 16}, {12, 64, 128}}};
    std::uint64_t voxels_ = 0;
};

}  // namespace topple
