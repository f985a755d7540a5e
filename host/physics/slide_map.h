// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/cell_columns.h"
#include "physics/sliding.h"

// The ground that one object slides on. For this folder.
namespace topple::physics {

// An object's columns, and the lowest cell of each.
struct Footprint {
    struct Column {
        std::int32_t i, j, low;
    };
    std::vector<Column> columns;  // sorted by (i, j)
    std::int32_t top = 0;         // highest cell of the object
    std::int32_t support = 0;     // highest cell of what it stands on
    bool stands = false;
};

// What a column means to the object: looked up once, in a window around its start.
class SlideMap {
  public:
    SlideMap(const SolidCells& cells, const CellColumns& columns,
             std::span<const std::int32_t> object, std::int32_t self, const Footprint& foot,
             const Vec3& center, double reach_m, const Unseen& unseen);

    // Before anything is asked of the map.
    void stand(const KnownFooting& stance);

    std::int32_t start_i() const { return start_i_; }
    std::int32_t start_j() const { return start_j_; }
    std::int32_t radius() const { return radius_; }  // of the window of positions, voxels

    // Whether the column is support.
    bool holds(std::int32_t i, std::int32_t j) { return ground(i, j).holds; }
    // With the centre of mass over column (i, j): can it be there, and does it fall from there?
    bool blocked(std::int32_t i, std::int32_t j);
    bool falls(std::int32_t i, std::int32_t j);
    // Not blocked, and what is below is known: ground, or a drop.
    bool passable(std::int32_t i, std::int32_t j);
    // Whether any column in reach lies above a drop.
    bool any_edge();
    // Below column (i, j); 0: unknown, or less than 2 voxels.
    std::int32_t drop_voxels(std::int32_t i, std::int32_t j) { return ground(i, j).below; }
    double drop_m(std::int32_t i, std::int32_t j) { return drop_voxels(i, j) * cells_.voxel_m; }
    double voxel_m() const { return cells_.voxel_m; }

  private:
    struct Ground {
        bool known = false, holds = false, obstacle = false;
        std::int32_t below = 0;  // drop to the next surface, voxels; 0 unknown
    };
    const Ground& ground(std::int32_t i, std::int32_t j);
    bool bears(std::int32_t shift_i, std::int32_t shift_j);

    const SolidCells& cells_;
    const CellColumns& columns_;
    std::span<const std::int32_t> object_;
    std::int32_t self_;
    const Footprint& foot_;
    Vec3 center_;
    const Unseen& unseen_;
    std::int32_t start_i_, start_j_, radius_, margin_, side_;
    std::vector<Ground> ground_;                 // lookups so far
    std::vector<std::uint8_t> blocked_, falls_;  // 0 not asked yet, 1 no, 2 yes
    std::vector<std::size_t> outline_;           // columns of the footprint that touch its outside
    Ground outside_;
};

// From the position of the centre of mass, voxels, straight along each of the ways.
std::vector<StraightSlide> straight_slides(SlideMap& map, const std::array<double, 2>& center,
                                           std::span<const std::array<double, 2>> ways);

}  // namespace topple::physics
