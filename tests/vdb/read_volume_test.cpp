// SPDX-License-Identifier: MIT
#include "vdb/read_volume.h"

#include <openvdb/io/File.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <array>
#include <set>

#include "device/devices.h"
#include "host/io/files.h"
#include "vdb/boxes.h"
#include "vdb/completion.h"
#include "vdb/voxel_scene.h"

namespace topple::vdb {
namespace {

using test::expect_input_error;

class ReadVolume : public test::Files {
  protected:
    std::filesystem::path save(const openvdb::GridBase::Ptr& grid,
                               const std::string& name = "a.vdb", double voxel = 0.05,
                               const openvdb::Vec3d& move = {0, 0, 0}) const {
        auto transform = openvdb::math::Transform::createLinearTransform(voxel);
        transform->postTranslate(move);
        grid->setTransform(transform);
        openvdb::io::File file(path(name).string());
        file.write({grid});
        file.close();
        return path(name);
    }
    // Distances of voxels to a sphere of `radius` voxels, known to `band` voxels from it.
    static openvdb::FloatGrid::Ptr sphere(double radius, double band) {
        openvdb::initialize();
        auto grid = openvdb::FloatGrid::create(static_cast<float>(band));
        const int reach = static_cast<int>(radius + band) + 1;
        for (int i = -reach; i <= reach; ++i) {
            for (int j = -reach; j <= reach; ++j) {
                for (int k = -reach; k <= reach; ++k) {
                    const double d = std::sqrt(i * i + j * j + k * k) - radius;
                    if (std::abs(d) < band)
                        grid->tree().setValueOn({i, j, k}, static_cast<float>(d));
                }
            }
        }
        return grid;
    }
};

TEST_F(ReadVolume, distances_give_surface_normals_and_free_space) {
    const auto map = read_volume(save(sphere(10, 3), "a.vdb", 0.05, {1, 2, 3}));
    // Crossings lie along each axis about as often as the sphere's shadow has voxels, twice.
    EXPECT_NEAR(static_cast<double>(map.cloud.size()), 3 * 2 * M_PI * 100, 60);
    for (std::size_t n = 0; n < map.cloud.size(); ++n) {
        const double x = map.cloud.x[n] - 1, y = map.cloud.y[n] - 2, z = map.cloud.z[n] - 3;
        const double r = std::sqrt(x * x + y * y + z * z);
        EXPECT_NEAR(r, 0.5, 0.002);
        EXPECT_GT((x * map.cloud.nx[n] + y * map.cloud.ny[n] + z * map.cloud.nz[n]) / r, 0.99);
    }
    EXPECT_DOUBLE_EQ(map.space.voxel_m, 0.05);
    EXPECT_NEAR(map.space.corner_m[2], 3, 1e-12);
    ASSERT_FALSE(map.space.free.empty());
    for (const auto& box : map.space.free) {
        const double i = box.low[0] + 0.5, j = box.low[1] + 0.5;
        for (std::int32_t k = box.low[2]; k <= box.high[2]; ++k) {
            const double d = std::sqrt(i * i + j * j + (k + 0.5) * (k + 0.5)) - 10;
            EXPECT_GT(d, 0);
            EXPECT_LT(d, 3);
        }
    }
}

// Where nobody looked the background has the sign of free space; it shows no surface there.
TEST_F(ReadVolume, what_is_not_active_shows_nothing) {
    const auto grid = sphere(10, 3);
    for (int i = -13; i <= 13; ++i) {
        for (int j = -13; j <= 13; ++j) {
            for (int k = -13; k < 0; ++k) grid->tree().setValueOff({i, j, k}, 3);
        }
    }
    const auto map = read_volume(save(grid));
    for (std::size_t n = 0; n < map.cloud.size(); ++n) {
        EXPECT_GE(map.cloud.z[n], 0);
        EXPECT_NEAR(std::hypot(map.cloud.x[n], map.cloud.y[n], map.cloud.z[n]), 0.5, 0.002);
    }
}

TEST_F(ReadVolume, labels_and_fog) {
    openvdb::initialize();
    auto labels = openvdb::Int32Grid::create(-1);
    auto fog = openvdb::FloatGrid::create(0);
    labels->denseFill(openvdb::CoordBBox({-9, -9, -9}, {9, 9, 9}), 0, true);
    labels->denseFill(openvdb::CoordBBox({-2, -2, -2}, {2, 2, 2}), 7, true);
    fog->denseFill(openvdb::CoordBBox({-2, -2, -2}, {2, 2, 2}), 1, true);
    const auto solid = read_volume(save(labels, "l.vdb", 0.1));
    EXPECT_EQ(solid.cloud.size(), 125u - 27u);
    std::uint64_t free = 0;
    for (const auto& box : solid.space.free)
        free += static_cast<std::uint64_t>(box.high[2] - box.low[2] + 1);
    EXPECT_EQ(free, 18u * 18 * 18 - 6 * 6 * 6);

    const auto cloud = read_volume(save(fog, "f.vdb", 0.1), 10);
    EXPECT_EQ(cloud.cloud.size(), 6u * 25);
    EXPECT_TRUE(cloud.space.free.empty());
    for (std::size_t n = 0; n < cloud.cloud.size(); ++n) {
        const double most = std::max(
            {std::abs(cloud.cloud.x[n]), std::abs(cloud.cloud.y[n]), std::abs(cloud.cloud.z[n])});
        EXPECT_NEAR(most, 2.5, 1e-6);
    }
}

TEST_F(ReadVolume, bad_files) {
    expect_input_error([&] { read_volume(write("a.vdb", "not a volume")); },
                       {"a.vdb", "no OpenVDB"});
    auto file = save(sphere(5, 2));
    const auto bytes = test::bytes_of_file(file);
    expect_input_error([&] { read_volume(write("b.vdb", bytes.substr(0, bytes.size() / 2))); },
                       {"b.vdb", "is cut short"});
    // Cut within a table, or by a little.
    const auto large = test::bytes_of_file(save(sphere(20, 3)));
    ASSERT_GT(large.size(), 6000u);
    for (const std::size_t size : {std::size_t{120}, std::size_t{5000}, large.size() - 1})
        expect_input_error([&] { read_volume(write("b.vdb", large.substr(0, size))); }, {"b.vdb"});
    expect_input_error([&] { read_volume(write("b.vdb", large.substr(0, 5000))); },
                       {"b.vdb", "is cut short", std::to_string(large.size()), "5000"});
    expect_input_error([&] { read_volume(save(openvdb::FloatGrid::create(1))); }, {"no surface"});
    expect_input_error([&] { read_volume(save(openvdb::BoolGrid::create(true))); }, {"no grid of"});
}

// Counts and lengths are checked before OpenVDB believes them.
TEST_F(ReadVolume, promises_beyond_the_file) {
    const auto good = test::bytes_of_file(save(sphere(5, 2)));
    const std::string map = "UniformScaleTranslateMap";
    const std::size_t at = good.find(map), counts = at + map.size() + 144 + 8;
    ASSERT_NE(at, std::string::npos) << "the map is another";
    const auto with = [&](std::size_t place, std::uint32_t value) {
        std::string bytes = good;
        std::memcpy(bytes.data() + place, &value, 4);
        return write("c.vdb", bytes);
    };
    EXPECT_NO_THROW(read_volume(with(counts, 0)));  // it had no tiles
    const std::string fault = "more than the file has bytes for";
    expect_input_error([&] { read_volume(with(counts, 1u << 30)); }, {"1073741824 tiles", fault});
    expect_input_error([&] { read_volume(with(counts + 4, 1u << 30)); }, {"nodes", fault});
    expect_input_error([&] { read_volume(with(at - 4, 1u << 30)); }, {"map", "1073741824 bytes"});
    expect_input_error([&] { read_volume(with(8, 100)); }, {"file version 100"});
    const std::size_t metadata = 8 + 4 + 8 + 1 + 36;
    expect_input_error([&] { read_volume(with(metadata, 1u << 31)); }, {"entries", fault});
}

// What the checks know of a file is what OpenVDB writes.
TEST_F(ReadVolume, any_map_and_a_stream) {
    using openvdb::math::Transform;
    const auto grid = sphere(5, 2);
    const auto linear = [](double x, double turn, double move) {
        auto transform = Transform::createLinearTransform(0.1);
        if (x != 1) transform->preScale(openvdb::Vec3d(x, 1, 1));
        if (turn != 0) transform->postRotate(turn, openvdb::math::Y_AXIS);
        if (move != 0) transform->postTranslate({move, 0, 0});
        return transform;
    };
    for (const auto& transform : {linear(1, 0, 0), linear(1, 0, 2), linear(2, 0, 0),
                                  linear(2, 0, 2), linear(1, 0.5, 0), linear(2, 0.5, 2)}) {
        grid->setTransform(transform);
        openvdb::io::File(path("m.vdb").string()).write({grid, sphere(3, 1), grid});
        EXPECT_GT(read_volume(path("m.vdb")).cloud.size(), 100u) << transform->mapType();
    }
    std::ofstream out(path("s.vdb"), std::ios::binary);
    openvdb::io::Stream(out).write(openvdb::GridCPtrVec{grid});
    out.close();
    EXPECT_GT(read_volume(path("s.vdb")).cloud.size(), 100u);
}

TEST_F(ReadVolume, a_real_fog_volume) {
    const char* shared = std::getenv("TOPPLE_SHARED");
    const std::filesystem::path file =
        std::filesystem::path(shared ? shared : "") / "data/maps/sphere.vdb";
    if (!shared || !std::filesystem::exists(file)) GTEST_SKIP() << "no data/maps/sphere.vdb";
    const auto map = read_volume(file);
    ASSERT_GT(map.cloud.size(), 1000u);
    const auto mean = [&](const std::vector<float>& values) {
        return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
    };
    const Vec3 middle{mean(map.cloud.x), mean(map.cloud.y), mean(map.cloud.z)};
    double least = 1e9, most = 0;
    for (std::size_t n = 0; n < map.cloud.size(); ++n) {
        const double r = std::hypot(map.cloud.x[n] - middle[0], map.cloud.y[n] - middle[1],
                                    map.cloud.z[n] - middle[2]);
        least = std::min(least, r);
        most = std::max(most, r);
    }
    std::printf("%zu points, radius %.4f to %.4f\n", map.cloud.size(), least, most);
    EXPECT_LT(most, 1.1 * least);
}

VoxelScene of_one_point(double voxel_m) {
    return {{voxel_m, {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}},
            test::cloud_of<std::vector<Vec3>>({{0.05, 0.05, 0.05}}),
            std::vector<std::int32_t>{0}};
}

TEST_F(ReadVolume, free_space_becomes_empty_voxels) {
    // A voxel of surface amid free ones, some of them far beyond the scene's bounds.
    VoxelScene scene = of_one_point(0.1);
    SpaceMap space;
    space.voxel_m = 0.1;
    space.free = {{{-3, -3, -3}, {3, 3, 3}}, {{100, 0, 0}, {140, 15, 15}}};
    scene.set_free(space);
    EXPECT_EQ(scene.state_at(0, 0, 0), State::surface);
    EXPECT_EQ(scene.state_at(-3, 3, 1), State::empty);
    EXPECT_EQ(scene.state_at(-4, 0, 0), State::invisible);
    EXPECT_EQ(scene.state_at(140, 15, 15), State::empty);
    EXPECT_EQ(scene.state_at(141, 0, 0), State::invisible);
    std::uint64_t empty = 0, surface = 0;
    for (const std::uint8_t s : scene.states(scene.tiles(true))) {
        empty += s == 0;
        surface += s == 1;
    }
    EXPECT_EQ(surface, 1u);
    EXPECT_EQ(empty, 7u * 7 * 7 - 1 + 41 * 16 * 16);
    // Twice is the same; a map of everything is refused.
    scene.set_free(space);
    space.free = {{{-32768, -32768, -32768}, {32767, 32767, 32767}}};
    expect_input_error([&] { scene.set_free(space); }, {"8x8x8", "limit"});
    // Shifted by half a voxel, only voxels whose centre is free are.
    VoxelScene other = of_one_point(0.1);
    space.corner_m = {0.06, 0, 0};
    space.free = {{{1, 0, 0}, {1, 0, 0}}};
    other.set_free(space);
    EXPECT_EQ(other.state_at(2, 0, 0), State::empty);
    EXPECT_EQ(other.state_at(1, 0, 0), State::invisible);
}

TEST_F(ReadVolume, solid_space_becomes_voxels_without_points) {
    SpaceMap space;
    space.voxel_m = 0.1;
    space.free = {{{-3, -3, -3}, {3, 3, 3}}};
    space.solid = {{{10, 0, 0}, {12, 0, 1}}, {{96, 8, 8}, {111, 23, 23}}};
    VoxelScene scene = of_one_point(0.1);
    scene.set_free(space);
    SolidCells cells = scene.solid_cells();
    commit(map_claims(scene, space), scene, cells);
    EXPECT_EQ(cells.size(), 1u + 6 + 16 * 16 * 16);
    EXPECT_EQ(std::ranges::count(cells.primitive, 0), 1);
    EXPECT_EQ(std::ranges::count(cells.basis, Basis::surface), std::ssize(cells.basis));
    EXPECT_EQ(scene.state_at(12, 0, 1), State::surface);
    EXPECT_EQ(scene.state_at(13, 0, 1), State::invisible);
    EXPECT_EQ(scene.state_at(1, 0, 0), State::empty);
    // Twice the voxels: those whose centre lies within.
    VoxelScene finer = of_one_point(0.05);
    space.solid = {{{0, 0, 1}, {0, 0, 1}}};
    SolidCells fine = finer.solid_cells();
    commit(map_claims(finer, space), finer, fine);
    EXPECT_EQ(fine.size(), 1u + 8);
    EXPECT_EQ(finer.state_at(1, 1, 3), State::surface);
}

using WriteVdb = test::Files;

TEST_F(WriteVdb, ReadsBackTheSame) {
    const auto boxes = test::Boxes::on_a_floor();
    const VoxelFrame frame{0.03, {Vec3{0.8, 0, 0.6}, Vec3{0, 1, 0}, Vec3{-0.6, 0, 0.8}}};
    VoxelScene scene(frame, boxes.cloud, boxes.label);
    auto device = device::open_device("native");
    scene.carve(*device, boxes.intrinsics, boxes.frames);
    fill(*device, scene, {.votes = 2, .roles = {Role::wall}});
    scene.set_objects(std::vector<std::int32_t>{7, 8});
    const auto solids = scene.solid_cells();
    std::vector<float> wind(solids.size(), 0.0f);
    wind[5] = 2.5f;
    const auto add = [&](const char* name, std::span<const float> values) {
        scene.add_field(name, solids.i, solids.j, solids.k, values);
    };
    add("wind", wind);
    EXPECT_THROW(add("wind", wind), Error);
    EXPECT_THROW(add("state", wind), Error);
    EXPECT_THROW(add("human", std::span(wind).first(3)), Error);
    const auto path = folder_ / "volume.vdb";
    scene.write(path);

    openvdb::initialize();
    openvdb::io::File file(path.string());
    file.open();
    const auto state = openvdb::gridPtrCast<openvdb::Int32Grid>(file.readGrid("state"));
    const auto primitive = openvdb::gridPtrCast<openvdb::Int32Grid>(file.readGrid("primitive"));
    const auto object = openvdb::gridPtrCast<openvdb::Int32Grid>(file.readGrid("object"));
    const auto field = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("wind"));
    EXPECT_EQ(file.getMetadata()->metaValue<double>("voxel_size_m"), 0.03);
    EXPECT_EQ(primitive->background(), -1);
    EXPECT_EQ(object->background(), -1);
    const auto cells = scene.solid_cells();
    const auto solid = solid_voxels(frame, cells, std::vector<std::int32_t>{7, 8});
    EXPECT_EQ(state->activeVoxelCount(), cells.size());
    EXPECT_EQ(primitive->activeVoxelCount(), cells.size());
    EXPECT_EQ(object->activeVoxelCount(), cells.size());
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const openvdb::Coord at(cells.i[n], cells.j[n], cells.k[n]);
        ASSERT_EQ(state->tree().getValue(at), cells.basis[n] == Basis::surface ? 1 : 3);
        ASSERT_EQ(primitive->tree().getValue(at), cells.primitive[n]);
        ASSERT_EQ(object->tree().getValue(at), solid.object[n]);
        const auto world = state->indexToWorld(at);
        ASSERT_NEAR(world.x(), solid.x[n], 1e-5);
        ASSERT_NEAR(world.y(), solid.y[n], 1e-5);
        ASSERT_NEAR(world.z(), solid.z[n], 1e-5);
    }
    // Every state, empty and invisible ones too.
    const auto all = scene.tiles(true);
    const auto states = scene.states(all);
    std::size_t wrong = 0;
    for (std::size_t n = 0; n < states.size(); ++n) {
        const int v = static_cast<int>(n % 512);
        const openvdb::Coord at(all.x[n / 512] + (v >> 6), all.y[n / 512] + (v >> 3 & 7),
                                all.z[n / 512] + (v & 7));
        wrong += state->tree().getValue(at) != states[n];
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(field->activeVoxelCount(), 1u);
    EXPECT_EQ(field->tree().getValue({solids.i[5], solids.j[5], solids.k[5]}), 2.5f);
}

TEST_F(WriteVdb, OpensWithVdbPrint) {
    if (std::system("command -v vdb_print > /dev/null") != 0)
        GTEST_SKIP() << "vdb_print is missing: libopenvdb-tools";
    const auto boxes = test::Boxes::on_a_floor();
    VoxelScene scene({}, boxes.cloud, boxes.label);
    scene.write(folder_ / "volume.vdb");
    const auto listing = folder_ / "listing";
    ASSERT_EQ(
        std::system(("vdb_print -l " + (folder_ / "volume.vdb").string() + " > " + listing.string())
                        .c_str()),
        0);
    for (const char* name : {"state", "primitive", "object"})
        EXPECT_THAT(test::bytes_of_file(listing), testing::HasSubstr(name));
}

TEST_F(WriteVdb, EmptySceneWrites) {
    VoxelScene scene({}, {}, {});
    scene.write(folder_ / "volume.vdb");
    openvdb::io::File file((folder_ / "volume.vdb").string());
    file.open();
    EXPECT_EQ(file.readGrid("state")->activeVoxelCount(), 0u);
}

TEST_F(WriteVdb, SaysWhatCannotBeWritten) {
    VoxelScene scene({}, {}, {});
    for (const auto& path : {folder_ / "absent" / "volume.vdb", std::filesystem::path("/dev/full")})
        test::expect_input_error([&] { scene.write(path); }, {path.native()});
}

TEST_F(ReadVolume, states_of_our_own_come_back) {
    VoxelScene scene(VoxelFrame{.voxel_m = 0.05});
    std::vector<std::uint8_t> states(512, static_cast<std::uint8_t>(State::invisible));
    const auto at = [](std::size_t x, std::size_t y, std::size_t z) { return x * 64 + y * 8 + z; };
    for (const std::size_t z : {0, 1, 2, 5}) states[at(1, 2, z)] = 0;
    states[at(1, 2, 3)] = static_cast<std::uint8_t>(State::surface);
    scene.put_leaf({8, 0, -8}, states);
    scene.put_label(9, 2, -5, 0);
    scene.put_leaf({16, 0, 0}, std::vector<std::uint8_t>(512, 0));
    scene.write(path("own.vdb"));
    const ScannedMap map = read_states(path("own.vdb"));
    EXPECT_NEAR(map.space.voxel_m, 0.05, 1e-12);
    ASSERT_EQ(map.cloud.x.size(), 1u);
    EXPECT_NEAR(map.cloud.x[0], 9.5 * 0.05, 1e-6);
    EXPECT_NEAR(map.cloud.z[0], -4.5 * 0.05, 1e-6);
    std::set<std::array<std::int32_t, 3>> free;
    for (const SpaceMap::Box& box : map.space.free)
        for (std::int32_t i = box.low[0]; i <= box.high[0]; ++i)
            for (std::int32_t j = box.low[1]; j <= box.high[1]; ++j)
                for (std::int32_t k = box.low[2]; k <= box.high[2]; ++k)
                    EXPECT_TRUE(free.insert({i, j, k}).second);
    EXPECT_EQ(free.size(), 512u + 4);
    EXPECT_TRUE(free.contains({9, 2, -3}) && free.contains({9, 2, -8}) &&
                free.contains({23, 7, 7}));
    expect_input_error([&] { read_states(save(sphere(5, 3))); }, {"a.vdb", "no volume of topple"});
}

}  // namespace
}  // namespace topple::vdb
