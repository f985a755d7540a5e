// SPDX-License-Identifier: MIT
#include "points/voxel_size.h"

#include <gtest/gtest.h>

namespace topple {
namespace {

// The voxels of a level square of this edge.
double voxel_for_square(double cell_m, double edge_m, double points,
                        std::uint64_t max_memory_bytes) {
    const auto edge = static_cast<float>(edge_m);
    return voxel_for_scan(cell_m, edge_m * edge_m, {{0, 0, 0}, {edge, edge, 0.05f}}, points,
                          max_memory_bytes);
}

TEST(VoxelSize, DenseScansGetFinerVoxelsThanRooms) {
    EXPECT_DOUBLE_EQ(voxel_for_square(0.002, 5, 1e6, 0), 0.005);
    EXPECT_DOUBLE_EQ(voxel_for_square(0.01, 5, 1e6, 0), 0.02);
}

TEST(VoxelSize, SparseRoomsGetThoseOfRooms) {
    for (const double cell : {0.02, 0.03, 0.06})
        EXPECT_DOUBLE_EQ(voxel_for_square(cell, 8, 1e4, 0), 0.02) << cell;
}

TEST(VoxelSize, HallsGetLargerOnesButNoneWithoutGaps) {
    // 45 x 45 m: five million voxels of 2 cm, two of 3 cm.
    EXPECT_DOUBLE_EQ(voxel_for_square(0.04, 45, 1e6, 0), 0.03);
    EXPECT_DOUBLE_EQ(voxel_for_square(0.012, 45, 1e6, 0), 0.03);
    EXPECT_DOUBLE_EQ(voxel_for_square(0.01, 45, 1e6, 0), 0.02);
}

TEST(VoxelSize, MemoryMakesThemLarger) {
    const double free = voxel_for_square(0.06, 8, 1e5, 0),
                 tight = voxel_for_square(0.06, 8, 1e5, 550 << 20);
    EXPECT_DOUBLE_EQ(free, 0.02);
    EXPECT_DOUBLE_EQ(tight, 0.03);
    EXPECT_DOUBLE_EQ(voxel_for_square(0.06, 8, 1e5, 1), voxel_for_cell(0.06));
}

TEST(VoxelSize, WhatIsAskedForOrKnownWins) {
    Observation input;
    input.cell_m = 0.02;
    ParseOptions options;
    EXPECT_DOUBLE_EQ(voxel_for_input(input, options), 0.02);
    input.voxel_m = 0.08;
    EXPECT_DOUBLE_EQ(voxel_for_input(input, options), 0.08);
    options.voxel_m = 0.05;
    EXPECT_DOUBLE_EQ(voxel_for_input(input, options), 0.05);
}

}  // namespace
}  // namespace topple
