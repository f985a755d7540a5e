// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "device/buffer.h"
#include "physics/landscape.h"

// What a SupportTable holds. For this folder and its tests.
namespace topple::physics {

// Rows are stored in tiles of directions, so that each tile fits a binding whatever the number of
// primitives.
struct SupportTable::Rows {
    SphereMesh mesh;
    std::uint32_t padded =
        0;                    // directions, rounded up to whole blocks; the rest repeat direction 0
    double spacing = 0;       // longest edge of the mesh, radians
    double resolution_m = 0;  // to which the vertices are known
    struct Tile {
        std::uint32_t first = 0, directions = 0;
        device::Buffer<float> s, dx, dy, dz;
    };
    std::vector<Tile> tiles;
    device::Buffer<std::uint32_t> neighbour;  // six planes, as kernel steepest_descent wants them
    std::vector<Vec3> origin;                 // of each primitive's row and vertices, grid frame
    std::vector<std::vector<Vec3>> vertices;  // of each primitive's hull, relative to its origin
};

inline constexpr std::uint32_t direction_block = 128;

// The vertices of the convex hull of voxel corners, for each primitive, in voxels. Corners that lie
// inside the hull of their own i-slice are dropped exactly first; Qhull does the rest.
std::vector<std::vector<std::array<std::int32_t, 3>>> voxel_hulls(const SolidCells& cells,
                                                                  std::int32_t primitives);

}  // namespace topple::physics
