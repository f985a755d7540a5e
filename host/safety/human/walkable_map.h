// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "safety/fields.h"
#include "safety/human/human_field.h"

// Where people can walk and where they do (paper, 5.1.2, primary motion). Grid frame.
namespace topple::safety {

// Place of a cell of the map, or beside it.
struct Place {
    std::int64_t x, y;
    bool operator==(const Place&) const = default;
};

// Cell (x, y) spans (x0, y0) + [x, x + 1] x [y, y + 1] * cell_m; its index is y * nx + x.
struct WalkableMap {
    double cell_m = 0, x0 = 0, y0 = 0;
    std::int64_t nx = 0, ny = 0;
    std::vector<float> floor_m;  // height of the floor there, or of the floor nearest to it
    std::vector<std::int32_t> component;  // of walkable cells that hang together; -1: not walkable
    std::vector<std::uint32_t> walkable;  // the walkable cells, ascending
    std::int32_t components = 0;
    std::int64_t bridged = 0;  // cells without scanned floor that count as floor
    std::vector<std::string> notes;

    std::size_t size() const { return static_cast<std::size_t>(nx * ny); }
    bool inside(const Place& p) const { return p.x >= 0 && p.y >= 0 && p.x < nx && p.y < ny; }
    std::uint32_t index(const Place& p) const { return static_cast<std::uint32_t>(p.y * nx + p.x); }
    Place place(std::uint32_t cell) const { return {cell % nx, cell / nx}; }
    // Its middle, metres.
    std::array<double, 2> center(const Place& p) const {
        return {x0 + (static_cast<double>(p.x) + 0.5) * cell_m,
                y0 + (static_cast<double>(p.y) + 0.5) * cell_m};
    }
    // The map's cell under the voxel column (i, j); voxels are at most as wide as map cells.
    std::size_t cell_of(std::int32_t i, std::int32_t j) const;
    // Whether that column is on the map.
    bool holds(std::int32_t i, std::int32_t j) const;

    std::int32_t i0 = 0, j0 = 0;  // the voxel column at the map's corner
    double voxel_m = 0;
};

// A cell is walkable where there is floor (cells of floor primitives; holes up to largest_hole_m
// are closed by a disc) and no solid between step_height_m and body_height_m above it within
// body_radius_m. Walkable cells hang together over edges and corners where the floor changes by at
// most step_height_m. A map without walkable cells says in its notes why.
WalkableMap walkable_map(const Surroundings& surroundings, const HumanOptions& options);

// How often walks pass through each cell, and which way.
struct PrimaryMotion {
    unsigned paths = 0;
    // direction_count planes of the map's size: walks through the cell that head that way. A pair
    // of places is as likely in either order, so each path counts for both ways with half its
    // weight.
    std::vector<std::uint32_t> visits;
    // Each of the walks, as the cells of its corners.
    std::vector<std::vector<std::uint32_t>> corners;
    // Walks per event through cell c heading d.
    double frequency(unsigned d, std::size_t c, std::size_t cells) const {
        return visits[d * cells + c] * 0.5 / paths;
    }
};

// Shortest paths between random pairs of cells of one component: A* over eight neighbours (costs 1
// and sqrt 2, ties by heuristic, then by index), then drawn straight wherever the straight line is
// walkable, since the grid's eight headings are not people's. The first place is drawn from all
// walkable cells, the second from those of its component.
PrimaryMotion primary_motion(const WalkableMap& map, const HumanOptions& options);

// Both as the report draws them.
Walks drawn_walks(const WalkableMap& map, const PrimaryMotion& motion);

}  // namespace topple::safety
