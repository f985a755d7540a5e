// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/solid_scene.h"

namespace topple {

// The heights of a room's floors: of the tops of their cells, metres, grid frame.
class FloorHeights {
  public:
    FloorHeights() = default;  // of a room without any
    explicit FloorHeights(const SolidScene& solids);

    // Ascending: those with a hundredth of what is floor.
    std::span<const double> levels_m() const { return levels_m_; }
    // The highest of these that is not above the height; where there is none, the height itself.
    double below_m(double height_m) const;
    // How many times as strongly as the lowest floor another one shakes in an earthquake: by a
    // linear profile, 1 at the ground and 3 at the roof (ASCE/SEI 7-16, Eq. 13.3-1). Of what is not
    // a storey above it: 1.
    double shaking(double floor_m) const;
    // Of the middle one of all cells; -infinity without any.
    double middle_m() const;

  private:
    double voxel_m_ = 0;
    std::size_t all_ = 0;
    double roof_m_ = 0;                          // the highest of all that is solid
    std::map<std::int32_t, std::size_t> count_;  // of cells, by layer
    std::vector<double> levels_m_;
};

}  // namespace topple
