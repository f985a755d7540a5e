// SPDX-License-Identifier: MIT
#include "points/formats/octomap.h"

#include "clouds.h"
#include "files.h"
#include "octomap_files.h"

namespace topple::io {
namespace {

using test::expect_input_error;

class Octomap : public test::Files {};

using Voxels = std::set<std::array<int, 3>>;

// Of a cloud of their centres.
Voxels voxels_of(const PointCloud& cloud, double voxel_m) {
    Voxels out;
    for (const auto& p : test::points_of(cloud)) {
        const auto at = [&](std::size_t a) { return int(std::floor(p[a] / voxel_m)); };
        out.insert({at(0), at(1), at(2)});
    }
    return out;
}

// Of boxes that share none.
Voxels voxels_of(const std::vector<SpaceMap::Box>& boxes) {
    Voxels out;
    std::size_t count = 0;
    for (const auto& [low, high] : boxes) {
        for (int i = low[0]; i <= high[0]; ++i) {
            for (int j = low[1]; j <= high[1]; ++j)
                for (int k = low[2]; k <= high[2]; ++k, ++count) out.insert({i, j, k});
        }
    }
    EXPECT_EQ(count, out.size());
    return out;
}

// By key, from the map's middle on.
Voxels from_middle(const Voxels& keys) {
    Voxels out;
    for (const auto& [i, j, k] : keys) out.insert({i - 32768, j - 32768, k - 32768});
    return out;
}

TEST_F(Octomap, leaves_become_points_and_free_space) {
    octomap::OcTree tree = test::room_map();
    for (const bool binary : {true, false}) {
        SCOPED_TRACE(binary);
        const auto file =
            write(binary ? "a.bt" : "a.ot", binary ? test::binary_map(tree) : test::full_map(tree));
        EXPECT_TRUE(looks_like_octomap(file));
        const ScannedMap map = read_octomap(file);
        EXPECT_EQ(map.space.voxel_m, 0.05);
        octomap::OcTree again = test::room_map();
        const auto expected = test::voxels_of(again);
        EXPECT_EQ(voxels_of(map.cloud, 0.05), from_middle(expected.occupied));
        EXPECT_EQ(map.cloud.size(), expected.occupied.size());
        EXPECT_EQ(voxels_of(map.space.free), from_middle(expected.free));
        // The floor's normals point up, into the room, where it is no corner.
        for (std::size_t n = 0; n < map.cloud.size(); ++n) {
            const bool middle = map.cloud.z[n] < 0 && map.cloud.x[n] > 0 && map.cloud.x[n] < 2 &&
                                map.cloud.y[n] > 0.5 && map.cloud.y[n] < 2;
            if (middle) {
                EXPECT_GT(map.cloud.nz[n], 0.99f);
            }
        }
    }
}

// Of a cube that is occupied throughout only its hull is surface, however its leaves lie: here a
// leaf of 8 x 8 x 8 voxels, smaller ones around it, and unknown space around the whole.
TEST_F(Octomap, the_inside_of_what_is_occupied_is_no_surface) {
    octomap::OcTree tree(0.1);
    constexpr int side = 13;
    test::add_solid_cube(tree, {32768 - 2, 32768 - 3, 32768}, side);
    tree.setNodeValue(octomap::OcTreeKey(32768 - 3, 32768, 32768 + 4),
                      tree.getClampingThresMinLog());
    const ScannedMap map = read_octomap(write("a.bt", test::binary_map(tree)));
    const Voxels surface = voxels_of(map.cloud, 0.1), solid = voxels_of(map.space.solid);
    EXPECT_EQ(map.cloud.size(), surface.size());
    constexpr int low[] = {-2, -3, 0};
    for (int n = 0; n < side * side * side; ++n) {
        const std::array<int, 3> v{n / side / side, n / side % side, n % side};
        const bool hull = std::ranges::any_of(v, [&](int i) { return i == 0 || i == side - 1; });
        EXPECT_TRUE(
            (hull ? surface : solid).contains({v[0] + low[0], v[1] + low[1], v[2] + low[2]}));
    }
    EXPECT_EQ(surface.size() + solid.size(), std::size_t{side * side * side});
}

// Some hundred bytes that promise a cube of two million voxels take what its hull takes.
TEST_F(Octomap, a_huge_leaf_is_read_for_its_hull) {
    std::string bytes = "# Octomap OcTree binary file\nid OcTree\nsize 10\nres 0.1\ndata\n";
    for (int depth = 0; depth < 8; ++depth) bytes.append("\x03").push_back('\0');
    bytes.append("\x02").push_back('\0');  // an occupied leaf at depth 9, of 128 voxels
    const ScannedMap map = read_octomap(write("a.bt", bytes));
    EXPECT_EQ(map.cloud.size(), 128u * 128 * 128 - 126 * 126 * 126);
    ASSERT_EQ(map.space.solid.size(), 1u);
    EXPECT_EQ(map.space.solid[0].high[2] - map.space.solid[0].low[2], 125);
}

TEST_F(Octomap, reading_can_be_cancelled) {
    const auto file = write("a.bt", test::binary_map(test::room_map()));
    struct Cancelled {};
    EXPECT_THROW(read_octomap(file, 1, [] { throw Cancelled{}; }), Cancelled);
}

TEST_F(Octomap, units_scale_the_map) {
    const ScannedMap map = read_octomap(write("a.bt", test::binary_map(test::room_map())), 0.1);
    EXPECT_DOUBLE_EQ(map.space.voxel_m, 0.005);
    EXPECT_NEAR(*std::max_element(map.cloud.x.begin(), map.cloud.x.end()), 0.005 * 53.5, 1e-6);
}

TEST_F(Octomap, states_come_back_as_they_were_written) {
    // A free block, a mixed one with surface, free, unseen and completed voxels, one far away.
    const std::vector<std::int32_t> x{-8, 0, 32760}, y{0, 8, -32768}, z{16, 0, 0};
    std::vector<std::uint8_t> states(3 * 512, 2);
    std::fill_n(states.begin(), 512, std::uint8_t{0});
    for (std::size_t n = 0; n < 512; ++n) states[512 + n] = static_cast<std::uint8_t>(n % 4);
    states[1024] = 1;
    write_octomap(path("a.bt"), 0.02, {x, y, z, states});
    const auto read = test::voxels_of(path("a.bt"));
    EXPECT_EQ(read.occupied.size(), 128u + 1);
    EXPECT_EQ(read.free.size(), 512u + 128);
    EXPECT_TRUE(read.free.contains({32768 - 8, 32768 + 7, 32768 + 16}));
    EXPECT_TRUE(read.occupied.contains({32768 + 32760, 0, 32768}));
    EXPECT_TRUE(read.occupied.contains({32768, 32768 + 8, 32768 + 1}));
    EXPECT_EQ(read_octomap(path("a.bt")).cloud.size(), 129u);

    const std::vector<std::int32_t> beyond{32768};
    expect_input_error(
        [&] {
            write_octomap(path("b.bt"), 0.02,
                          {beyond, beyond, beyond, std::span(states).first(512)});
        },
        {"b.bt", "655.36", "voxel_m (--voxel)"});
}

TEST_F(Octomap, bad_files) {
    const std::string head = "# Octomap OcTree binary file\nid OcTree\nsize 1\nres 0.1\ndata\n";
    const std::string full = "# Octomap OcTree file\nid OcTree\nsize 1\nres 0.1\ndata\n";
    const std::string good = test::binary_map(test::room_map());
    std::string deep = head, deep_full = full;
    for (int n = 0; n < 40; ++n) deep.append("\x03").push_back('\0');
    for (int n = 0; n < 40; ++n) {
        test::append<float>(deep_full, 0.5f);
        deep_full.push_back('\x01');
    }
    std::string whole = full;  // a root without children: all of space is occupied
    test::append<float>(whole, 3);
    whole.push_back('\0');
    std::string nan = full;
    test::append<float>(nan, std::nanf(""));
    nan.push_back('\0');
    const std::string zeros(2, '\0');
    const struct {
        std::string bytes;
        std::vector<std::string_view> message;
    } cases[] = {
        {"something else", {"\"# Octomap OcTree\""}},
        {head, {"without a tree"}},
        {head + zeros, {"inner node without a child"}},
        {head + "\x01" + std::string(1, '\0'), {"no occupied leaf"}},
        {head + "\x03" + std::string(1, '\0') + zeros, {"inner node without a child"}},
        {deep, {"deeper than the 16"}},
        {deep_full, {"deeper than the 16"}},
        {whole, {"8388608", "thin"}},
        {nan, {"not finite"}},
        {good.substr(0, good.size() - 1), {"cut short"}},
        {"# Octomap OcTree binary file\nid OcTree\ndata\n..", {"no line `res`"}},
        {"# Octomap OcTree binary file\nid OcTree\nres nan\ndata\n..", {"line 3", "\"nan\""}},
        {"# Octomap OcTree binary file\nid OcTree\nres -1\ndata\n..", {"line 3", "\"-1\""}},
        {"# Octomap OcTree file\nid ColorOcTree\nres 0.1\ndata\n..", {"\"ColorOcTree\""}},
        {"# Octomap OcTree file\nid OcTree\nwhat 5\ndata\n..", {"line 3", "\"what\""}},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(*c.message.begin());
        expect_input_error([&] { read_octomap(write("a.bt", c.bytes)); }, c.message);
    }
}

}  // namespace
}  // namespace topple::io
