// SPDX-License-Identifier: MIT
#include "clouds.h"
#include "core/random.h"
#include "errors.h"
#include "lab/temporary_folder.h"
#include "scale/blocks.h"
#include "scale/point_spill.h"
#include "scale/thinned_bin.h"
#include "scale/work_files.h"

namespace topple::tiles {
namespace {

// Points over a few bins, on both sides of the origin.
PointCloud scattered(std::size_t count) {
    Random random(3);
    PointCloud cloud;
    for (std::size_t n = 0; n < count; ++n)
        test::add(cloud, random.uniform(-7, 8), random.uniform(-1, 1), random.uniform(0, 0.2));
    return cloud;
}

void spill(const std::filesystem::path& folder, const PointCloud& cloud,
           std::uint64_t buffer_bytes) {
    PointSpill out(folder, buffer_bytes);
    // In portions of an odd size.
    for (std::size_t first = 0; first < cloud.size(); first += 777) {
        PointCloud portion;
        for (std::size_t n = first; n < std::min(cloud.size(), first + 777); ++n) {
            test::add(portion, cloud.x[n], cloud.y[n], cloud.z[n]);
            if (cloud.red.empty()) continue;
            portion.red.push_back(cloud.red[n]);
            portion.green.push_back(cloud.green[n]);
            portion.blue.push_back(cloud.blue[n]);
        }
        out.add(portion, "cloud");
    }
    out.finish();
}

TEST(Spill, KeepsThePointsOfEachBinInOrderWhateverItsBuffer) {
    const PointCloud cloud = scattered(20'000);
    std::map<Bin, std::vector<float>> expected;  // x of each bin's points
    for (std::size_t n = 0; n < cloud.size(); ++n)
        expected[bin_of(cloud.x[n], cloud.y[n], cloud.z[n])].push_back(cloud.x[n]);
    for (const std::uint64_t buffer : {std::uint64_t{1}, std::uint64_t{1} << 30}) {
        scenes::TemporaryFolder folder("topple_tiles");
        spill(folder.path(), cloud, buffer);
        const SpilledPoints points(folder.path());
        EXPECT_EQ(points.points(), cloud.size());
        ASSERT_EQ(points.bins().size(), expected.size());
        auto bin = expected.begin();
        for (std::size_t b = 0; b < points.bins().size(); ++b, ++bin) {
            EXPECT_EQ(points.bins()[b].bin, bin->first);
            std::vector<float> x;
            points.read(b, [&](std::span<const Point> portion, std::span<const Rgb8>) {
                for (const Point& p : portion) x.push_back(p.x);
            });
            EXPECT_EQ(x, bin->second);
        }
    }
}

// Colours that say where their points are come back with them, and thinned as their means.
TEST(Spill, KeepsColours) {
    PointCloud cloud = scattered(20'000);
    scenes::TemporaryFolder plain("topple_tiles");
    spill(plain.path(), cloud, 1 << 12);
    EXPECT_FALSE(SpilledPoints(plain.path()).coloured());
    const auto byte = [](float v) {
        return static_cast<std::uint8_t>(1 + std::abs(static_cast<int>(v * 50)) % 200);
    };
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        const bool known = n % 4 != 0;
        cloud.red.push_back(known ? byte(cloud.x[n]) : std::uint8_t{0});
        cloud.green.push_back(known ? byte(cloud.y[n]) : std::uint8_t{0});
        cloud.blue.push_back(known ? 77 : 0);
    }
    for (const std::uint64_t buffer : {std::uint64_t{1}, std::uint64_t{1} << 30}) {
        scenes::TemporaryFolder folder("topple_tiles");
        spill(folder.path(), cloud, buffer);
        const SpilledPoints points(folder.path());
        ASSERT_TRUE(points.coloured());
        std::size_t known = 0;
        for (std::size_t b = 0; b < points.bins().size(); ++b) {
            points.read(b, [&](std::span<const Point> portion, std::span<const Rgb8> colours) {
                ASSERT_EQ(colours.size(), portion.size());
                for (std::size_t n = 0; n < portion.size(); ++n) {
                    if (colours[n] == Rgb8{0, 0, 0}) continue;
                    ++known;
                    EXPECT_EQ(colours[n], (Rgb8{byte(portion[n].x), byte(portion[n].y), 77}));
                }
            });
            thin_bin(points, b, 0.5, folder.path());
            const ThinnedBin thinned = read_thinned(folder.path(), points.bins()[b].bin);
            ASSERT_EQ(thinned.red.size(), thinned.size());
            for (const std::uint8_t blue : thinned.blue) EXPECT_TRUE(blue == 77 || blue == 0);
        }
        EXPECT_EQ(known, 15'000u);
    }
    cloud.red.assign(cloud.size(), 0);
    cloud.green = cloud.blue = cloud.red;
    scenes::TemporaryFolder black("topple_tiles");
    spill(black.path(), cloud, 1 << 12);
    EXPECT_FALSE(SpilledPoints(black.path()).coloured()) << "none is known";
}

TEST(Spill, RefusesPointsThatAreSpreadTooThin) {
    scenes::TemporaryFolder folder("topple_tiles");
    PointSpill out(folder.path(), 1 << 20);
    PointCloud wide;
    for (int n = 0; n < 3000; ++n) test::add(wide, n * 6, 0, 0);
    test::expect_input_error([&] { out.add(wide, "wide.ply"); },
                             {"wide.ply", "unit_m = 0.001 (--unit mm)"});
}

TEST(Spill, ACutFileIsNoticed) {
    scenes::TemporaryFolder folder("topple_tiles");
    spill(folder.path(), scattered(1000), 1 << 20);
    std::filesystem::resize_file(folder.path() / "points.bin", 500);
    EXPECT_THROW(SpilledPoints{folder.path()}, Error);
    std::filesystem::resize_file(folder.path() / "bins.bin", 20);
    EXPECT_THROW(SpilledPoints{folder.path()}, Error);
}

TEST(Thinning, KeepsTheMeanOfEachCellAndTheCellOfEachPoint) {
    const PointCloud cloud = scattered(20'000);
    scenes::TemporaryFolder folder("topple_tiles");
    spill(folder.path(), cloud, 1 << 20);
    const SpilledPoints points(folder.path());
    const double cell_m = dividing_cell(0.06);
    EXPECT_NEAR(bin_edge_m / cell_m, std::round(bin_edge_m / cell_m), 1e-9);
    EXPECT_LE(cell_m, 0.06);
    for (std::size_t b = 0; b < points.bins().size(); ++b) {
        thin_bin(points, b, cell_m, folder.path());
        const Bin& bin = points.bins()[b].bin;
        EXPECT_TRUE(names_in(folder.path()).contains(thinned_name(bin)));
        const ThinnedBin thinned = read_thinned(folder.path(), bin);
        const CellsOfPoints cells(folder.path(), bin, cell_m);
        EXPECT_EQ(cells.size(), thinned.size());
        std::vector<std::array<double, 4>> sums(thinned.size());
        std::vector<std::array<std::int64_t, 3>> cell(thinned.size());
        points.read(b, [&](std::span<const Point> portion, std::span<const Rgb8>) {
            for (const Point& p : portion) {
                const std::uint32_t c = cells.find(p).value_or(UINT32_MAX);
                ASSERT_LT(c, thinned.size());
                sums[c][0] += p.x, sums[c][1] += p.y, sums[c][2] += p.z, sums[c][3] += 1;
                const std::array<std::int64_t, 3> at{
                    static_cast<std::int64_t>(std::floor((p.x - bin[0] * bin_edge_m) / cell_m)),
                    static_cast<std::int64_t>(std::floor((p.y - bin[1] * bin_edge_m) / cell_m)),
                    static_cast<std::int64_t>(std::floor((p.z - bin[2] * bin_edge_m) / cell_m))};
                if (sums[c][3] == 1) cell[c] = at;
                EXPECT_EQ(cell[c], at);
            }
        });
        const auto corner = [&](std::size_t axis) {
            return static_cast<float>((bin[axis] + 0.999) * bin_edge_m);
        };
        EXPECT_EQ(cells.find({corner(0), corner(1), corner(2)}), std::nullopt);
        EXPECT_TRUE(std::ranges::is_sorted(cell));
        for (std::size_t c = 0; c < thinned.size(); ++c) {
            EXPECT_EQ(thinned.points[c], sums[c][3]);
            EXPECT_NEAR(thinned.x[c], sums[c][0] / sums[c][3], 1e-5);
            EXPECT_NEAR(thinned.y[c], sums[c][1] / sums[c][3], 1e-5);
            EXPECT_NEAR(thinned.z[c], sums[c][2] / sums[c][3], 1e-5);
        }
    }
}

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
            for (double y = 0.2; y < 4.5; y += 0.05) test::add(cloud, x, y, z);
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
        for (std::size_t n = 0; n < thinned.size(); ++n) add_cell(thinned, n, made.cells);
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
        const auto at = made.layout.voxel_at(made.cells.x[n], made.cells.y[n], made.cells.z[n]);
        int cores = 0;
        for (std::size_t b = 0; b < 4; ++b) {
            if (!made.layout.blocks[b].core.holds(at)) continue;
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
