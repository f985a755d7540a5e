// SPDX-License-Identifier: MIT
#include "topple/error.h"
#include "vdb/grids.h"

namespace topple::vdb {

void VoxelScene::relabel(std::span<const std::int32_t> number) {
    for (auto leaf = grids_->primitive->tree().beginLeaf(); leaf; ++leaf) {
        for (auto voxel = leaf->beginValueOn(); voxel; ++voxel) {
            if (*voxel < 0) continue;
            if (static_cast<std::size_t>(*voxel) >= number.size()) {
                throw Error(ErrorKind::usage, "relabel: primitive " + std::to_string(*voxel) +
                                                  " is not among the " +
                                                  std::to_string(number.size()) + " given");
            }
            voxel.setValue(number[static_cast<std::size_t>(*voxel)]);
        }
    }
}

}  // namespace topple::vdb
