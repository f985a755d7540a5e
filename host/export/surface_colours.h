// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/colour_space.h"
#include "core/solid_cells.h"
#include "report/cell_colours.h"
#include "report/cells.h"
#include "topple/scene.h"
#include "vdb/voxel_scene.h"

namespace topple {

// What a scan shows of the colours of its objects' voxels; those that nobody saw have their
// neighbours'.
class SurfaceColours {
  public:
    // object_of_primitive: -1 for none.
    SurfaceColours(const ScenePoints& points, const SolidCells& cells,
                   std::span<const std::int32_t> object_of_primitive, const vdb::VoxelFrame& frame);

    // Of a corner of an object's voxels: the mean of those around it, next to it or one further.
    std::optional<Rgb8> at(const std::array<std::int32_t, 3>& corner, std::int32_t object) const;

  private:
    std::array<std::int32_t, 3> moved(const std::array<std::int32_t, 3>& cell) const;

    std::array<std::int32_t, 3> first_{};
    report::CellTable table_;
    std::vector<std::int32_t> object_;
    std::vector<std::optional<Rgb8>> seen_;
};

}  // namespace topple
