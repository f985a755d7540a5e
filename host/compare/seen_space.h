// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/space_map.h"
#include "topple/scene.h"

namespace topple::comparing {

// What a parse knows of each voxel of a room, in its grid frame (Scene::manhattan_from_input).
class SeenSpace {
  public:
    // What at() returns besides objects.
    static constexpr std::int32_t of_none = -1, free = -2, unseen = -3;

    // space: what was seen to be free, in voxels of the grid frame. Throws Error(input) for a scene
    // that is too large.
    SeenSpace(const Scene& scene, const SpaceMap& space);

    // The object whose solid is at a place, or nearest to it within the reach; of_none: solid of no
    // object. Else whether the place was seen to be free.
    std::int32_t at(const Vec3& place_m) const;
    // Whether something solid that is not of this object is within the reach of a place.
    bool near_others(const Vec3& place_m, std::int32_t object) const;

  private:
    using Cell = std::array<std::int64_t, 3>;
    Cell cell_at(const Vec3& place_m) const;
    std::int32_t cell(const Cell& at) const;

    double voxel_m_, reach_m_;
    Cell low_{}, size_{};
    std::vector<std::int32_t> cells_;
    std::vector<Cell> around_;  // the nearest first
};

}  // namespace topple::comparing
