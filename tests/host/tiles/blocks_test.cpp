// SPDX-License-Identifier: MIT
#include "scale/blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "clouds.h"
#include "lab/temporary_folder.h"
#include "scale/point_spill.h"
#include "scale/thinned_bin.h"

namespace topple::tiles {
namespace {

constexpr double cell_m = 0.05;

struct Cut {
    Layout layout;
    PointCloud cells;
};

// Two storeys of 7.1 x 4.3 m, which begin 6 cm before a multiple of the blocks' edge: floors and
// ceilings alone.
Cut cut(double ceiling_m, double floor_m, double voxel_m) {
    PointCloud cloud;
    for (const double z : {0.01, ceiling_m, floor_m, floor_m + ceiling_m})
        for (double x = -0.06; x < 7; x += 0.05)
            for (double y = 0.2; y < 4.5; y += 0.05) {
                test::add(cloud, x, y, z);
            }
    const scenes::TemporaryFolder folder("topple_blocks");
    PointSpill out(folder.path(), 1 << 20);
    out.add(cloud, "cloud");
    out.finish();
    const SpilledPoints points(folder.path());
    std::vector<Bin> bins;
    Cut made;
    for (std::size_t b = 0; b < points.bins().size(); ++b) {
        bins.push_back(points.bins()[b].bin);
        thin_bin(points, b, cell_m, folder.path());
        const ThinnedBin thinned = read_thinned(folder.path(), bins.back());
        made.cells.x.insert(made.cells.x.end(), thinned.x.begin(), thinned.x.end());
        made.cells.y.insert(made.cells.y.end(), thinned.y.begin(), thinned.y.end());
        made.cells.z.insert(made.cells.z.end(), thinned.z.begin(), thinned.z.end());
    }
    geometry::SceneFrame frame;
    frame.axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    made.layout = cut_into_blocks(folder.path(), bins, frame, cell_m, voxel_m);
    return made;
}

TEST(Blocks, EachCellIsInOneCoreAndRimsAreTheNextOnes) {
    constexpr double voxel_m = 0.025;
    const Cut made = cut(2.7, 3.1, voxel_m);
    // The 6 cm before the first multiple make no blocks of their own.
    ASSERT_EQ(made.layout.blocks.size(), 4);
    EXPECT_EQ(made.layout.blocks[0].core.low[0], -8);
    std::vector<std::uint64_t> cells(4, 0);
    for (std::size_t n = 0; n < made.cells.size(); ++n) {
        const auto at =
            voxel_at(made.layout.frame, voxel_m, made.cells.x[n], made.cells.y[n], made.cells.z[n]);
        int cores = 0;
        for (std::size_t b = 0; b < 4; ++b) {
            if (!made.layout.blocks[b].core.holds(at[0], at[1], at[2])) continue;
            ++cores;
            ++cells[b];
        }
        ASSERT_EQ(cores, 1) << made.cells.x[n] << " " << made.cells.y[n] << " " << made.cells.z[n];
    }
    for (std::size_t b = 0; b < 4; ++b) EXPECT_EQ(made.layout.blocks[b].cells, cells[b]);
    EXPECT_EQ(tiles_of(made.layout, 5).size(), 4);
    EXPECT_EQ(tiles_of(made.layout, 10).size(), 2);
}

TEST(Blocks, SeeTheSlabButNothingOfTheFloorOnIt) {
    constexpr double voxel_m = 0.025;
    const Layout layout = cut(2.7, 3.1, voxel_m).layout;
    ASSERT_EQ(layout.blocks.size(), 4);
    EXPECT_GE(layout.halo * voxel_m, 0.8);
    for (const Block& block : layout.blocks)
        EXPECT_EQ(block.seen.low[0], block.core.low[0] - layout.halo);
    for (const std::size_t lower : {0, 1}) {
        const Block& block = layout.blocks[lower];
        EXPECT_GT(block.core.high[2], 2.7 / voxel_m);
        EXPECT_GT(block.seen.high[2], block.core.high[2]);
        EXPECT_LT(block.seen.high[2], 3.08 / voxel_m);
    }
}

// Cuts lie at leaves, here of 0.4 m and above the floor: who has that in its core sees what stands
// on it.
TEST(Blocks, SeeAroundThinSlabs) {
    constexpr double voxel_m = 0.05;
    const Layout layout = cut(2.47, 2.77, voxel_m).layout;
    ASSERT_EQ(layout.blocks.size(), 4);
    for (const std::size_t lower : {0, 1}) {
        const Block& block = layout.blocks[lower];
        EXPECT_EQ(block.core.high[2], std::lround(2.8 / voxel_m));
        EXPECT_EQ(block.seen.high[2], block.core.high[2] + layout.halo);
    }
}

}  // namespace
}  // namespace topple::tiles
