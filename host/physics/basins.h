// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/landscape.h"

namespace topple::physics {

// The basins of one pose landscape, and how high one must climb to each from a start direction.
//
// A basin is what leads to one minimum by steepest descent, of equal directions to that of the
// least number. Two that meet have a saddle, the least of the higher ends of the mesh's edges
// between them; by those, taken as they rise (Kruskal 1956), basins join. The level of a direction,
//     L(v) = the least, over all paths from the start to v, of the highest energy on the way,
// is that of its basin's minimum or its own height, whichever is more: the descent from v never
// rises. Exact: each is the height of some direction.
class Basins {
  public:
    // down: the steepest neighbour of each direction, itself at a minimum (kernel
    // steepest_descent). It is overwritten, and must outlive this, as must height.
    Basins(std::span<const float> height, const SphereMesh& mesh, std::span<std::uint32_t> down,
           std::uint32_t start);

    std::span<const std::uint32_t> minima() const { return minima_; }  // directions, by number
    float level_of_minimum(std::size_t basin) const { return level_[basin]; }
    float level(std::uint32_t v) const { return std::max(height_[v], level_[basin_of_[v]]); }

  private:
    std::span<const float> height_;
    std::span<const std::uint32_t> basin_of_;
    std::vector<std::uint32_t> minima_;
    std::vector<float> level_;  // by basin
};

}  // namespace topple::physics
