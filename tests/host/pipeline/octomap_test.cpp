// SPDX-License-Identifier: MIT
#include <chrono>

#include "host/io/octomap_files.h"
#include "host/pipeline/scan.h"
#include "scale/estimate.h"

// A map goes through a parse, and what was seen to be free and occupied comes out as it went in.
namespace topple::test {
namespace {

class OctomapRoundTrip : public Files {
  protected:
    ParseResult expect_unchanged(const std::filesystem::path& map) {
        ParseResult result = parse(map, on(device::open_device("native")));
        EXPECT_EQ(result.scene.up_method, "map");
        EXPECT_GT(result.scene.objects.size(), 0u);
        OutputOptions options;
        options.octomap = true;
        write_outputs(result, path("out"), options);
        const OctomapVoxels before = voxels_of(map), after = voxels_of(path("out/map.bt"));
        std::printf("%zu occupied and %zu free voxels\n", before.occupied.size(),
                    before.free.size());
        EXPECT_TRUE(before.occupied == after.occupied) << after.occupied.size();
        EXPECT_TRUE(before.free == after.free) << after.free.size();
        return result;
    }
};

TEST_F(OctomapRoundTrip, is_estimated) {
    const Estimate e = estimate(write("room.bt", binary_map(room_map())), {});
    EXPECT_GT(e.points, 0u);
    EXPECT_GT(e.surface_m2, 0);
    EXPECT_FALSE(e.tiled);
}

// What lies within is no surface, but is as occupied as before, and is the pillar's.
TEST_F(OctomapRoundTrip, of_a_room_with_a_solid_pillar) {
    octomap::OcTree tree = room_map();
    add_solid_cube(tree, {32768, 32768 + 40, 32768}, 10);
    const ParseResult result = expect_unchanged(write("room.bt", binary_map(tree)));
    const SolidCells cells = result.voxels->solid_cells();
    std::size_t within = 0;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (cells.i[n] < 1 || cells.i[n] > 8 || cells.j[n] < 41 || cells.j[n] > 48 ||
            cells.k[n] < 1 || cells.k[n] > 8)
            continue;
        ++within;
        EXPECT_EQ(cells.basis[n], Basis::surface);
        EXPECT_GE(cells.primitive[n], 0);
    }
    EXPECT_EQ(within, 8u * 8 * 8);
}

TEST_F(OctomapRoundTrip, of_a_building) {
    const char* shared = std::getenv("TOPPLE_SHARED");
    const std::filesystem::path map =
        std::filesystem::path(shared ? shared : "") / "data/maps/geb079.bt";
    if (!shared || !std::filesystem::exists(map)) GTEST_SKIP() << "no data/maps/geb079.bt";
    expect_unchanged(map);
}

// With another --voxel or --up the grid is not the map's; the free space still counts.
TEST_F(OctomapRoundTrip, other_voxels_and_axes) {
    const auto map = write("room.bt", binary_map(room_map()));
    ParseOptions options = on(device::open_device("native"));
    options.voxel_m = 0.04;
    options.disturbances = {"wind"};
    const ParseResult finer = parse(map, options);
    EXPECT_EQ(finer.scene.voxel_size_m, 0.04);
    const Vec3 middle{0.5, 0.9, 1.2};
    EXPECT_EQ(state_at(finer, middle), vdb::State::empty);
    EXPECT_NE(state_at(finer, {1.15, 1.45, 0.71}), vdb::State::empty)
        << "the unknown inside of the table";
    options.voxel_m = 0;
    options.up = Vec3{0, 0.6, 0.8};
    const ParseResult askew = parse(map, options);
    EXPECT_EQ(askew.scene.up_method, "given");
    EXPECT_EQ(state_at(askew, middle), vdb::State::empty);
}

// Who cancels is heard within the stages that such a map takes long in.
TEST_F(OctomapRoundTrip, is_cancelled_within_stages) {
    const auto map = write("chequered.bt", chequered_map(6));
    using Clock = std::chrono::steady_clock;
    ParseOptions options = on(device::open_device("native"));
    std::string stage;
    int merging = 0;
    Clock::time_point last = Clock::now();
    Clock::duration longest{};
    options.progress = [&](std::string_view name, double) { stage = name; };
    options.cancelled = [&] {
        const auto now = Clock::now();
        longest = std::max(longest, now - last);
        last = now;
        merging += stage == "merging";
        return merging > 4;
    };
    EXPECT_THROW(parse(map, options), Error);
    EXPECT_EQ(stage, "merging");
    EXPECT_LT(longest, std::chrono::seconds(5));
}

}  // namespace
}  // namespace topple::test
