// SPDX-License-Identifier: MIT
#include "io/octomap.h"

#include <cmath>

#include "files.h"
#include "octomap_files.h"

namespace topple::io {
namespace {

using test::expect_input_error;

class Octomap : public test::Files {};

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
        std::set<std::array<int, 3>> occupied, free;
        for (std::size_t n = 0; n < map.cloud.size(); ++n) {
            occupied.insert({int(std::floor(map.cloud.x[n] / 0.05)) + 32768,
                             int(std::floor(map.cloud.y[n] / 0.05)) + 32768,
                             int(std::floor(map.cloud.z[n] / 0.05)) + 32768});
        }
        for (const auto& box : map.space.free) {
            for (int i = box.low[0]; i <= box.high[0]; ++i) {
                for (int j = box.low[1]; j <= box.high[1]; ++j) {
                    for (int k = box.low[2]; k <= box.high[2]; ++k)
                        free.insert({i + 32768, j + 32768, k + 32768});
                }
            }
        }
        EXPECT_EQ(occupied, expected.occupied);
        EXPECT_EQ(map.cloud.size(), expected.occupied.size());
        EXPECT_EQ(free, expected.free);
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
        {"b.bt", "655.36", "--voxel"});
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
        std::initializer_list<std::string_view> message;
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
