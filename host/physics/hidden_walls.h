// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "topple/scene.h"

namespace topple::physics {

// Where a wall goes on behind what hides it, by columns along it. Grid frame, metres.
struct HiddenWall {
    std::int32_t primitive = -1;              // a seen part of the wall
    std::array<double, 2> normal{}, along{};  // horizontal units
    double offset_m = 0;                      // normal . p of its points
    double from_m = 0, column_m = 0;  // along . p where the first column begins; their width
    double bottom_m = 0;
    std::vector<float> top_m;  // by column; -infinity: nothing hides it there
};

// Upright walls that nobody saw as a whole. They stop what falls, and are no solids.
class HiddenWalls {
  public:
    HiddenWalls() = default;
    explicit HiddenWalls(std::vector<HiddenWall> walls) : walls_(std::move(walls)) {}

    std::size_t size() const { return walls_.size(); }
    // The wall's primitive where one stands between two points, at the height of the second.
    std::optional<std::int32_t> between(const Vec3& from, const Vec3& to) const;

  private:
    std::vector<HiddenWall> walls_;
};

}  // namespace topple::physics
