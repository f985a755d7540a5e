// SPDX-License-Identifier: MIT
#include "pipeline/voxel_size.h"

#include <gtest/gtest.h>

namespace topple {
namespace {

// A level square of this edge.
SurfaceExtent square(double edge_m) {
    SurfaceExtent out;
    for (double x = 0.025; x < edge_m; x += 0.05)
        for (double y = 0.025; y < edge_m; y += 0.05) out.add(x, y, 0.01);
    return out;
}

TEST(VoxelSize, DenseScansGetFinerVoxelsThanRooms) {
    EXPECT_DOUBLE_EQ(voxel_for_scan(0.002, square(5), 1e6, 0), 0.005);
    EXPECT_DOUBLE_EQ(voxel_for_scan(0.01, square(5), 1e6, 0), 0.02);
}

TEST(VoxelSize, SparseRoomsGetThoseOfRooms) {
    for (const double cell : {0.02, 0.03, 0.06})
        EXPECT_DOUBLE_EQ(voxel_for_scan(cell, square(8), 1e4, 0), 0.02) << cell;
}

TEST(VoxelSize, HallsGetLargerOnesButNoneWithoutGaps) {
    // 45 x 45 m: five million voxels of 2 cm, two of 3 cm.
    EXPECT_DOUBLE_EQ(voxel_for_scan(0.04, square(45), 1e6, 0), 0.03);
    EXPECT_DOUBLE_EQ(voxel_for_scan(0.012, square(45), 1e6, 0), 0.03);
    EXPECT_DOUBLE_EQ(voxel_for_scan(0.01, square(45), 1e6, 0), 0.02);
}

TEST(VoxelSize, MemoryMakesThemLarger) {
    const SurfaceExtent room = square(8);
    const double free = voxel_for_scan(0.06, room, 1e5, 0),
                 tight = voxel_for_scan(0.06, room, 1e5, 500 << 20);
    EXPECT_DOUBLE_EQ(free, 0.02);
    EXPECT_DOUBLE_EQ(tight, 0.03);
    EXPECT_DOUBLE_EQ(voxel_for_scan(0.06, room, 1e5, 1), voxel_for_cell(0.06));
}

TEST(VoxelSize, WhatIsAskedForOrKnownWins) {
    Ingested input;
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
