// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "device/devices.h"
#include "errors.h"
#include "topple/error.h"
#include "vdb/boxes.h"
#include "vdb/completion.h"
#include "vdb/voxel_scene.h"

namespace topple::vdb {
namespace {

class WriteVdb : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  ("topple_" + std::string(info->name()) + "_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path folder_;
};

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
    std::stringstream text;
    text << std::ifstream(listing).rdbuf();
    for (const char* name : {"state", "primitive", "object"}) {
        EXPECT_NE(text.str().find(name), std::string::npos) << text.str();
    }
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
    for (const auto& path :
         {folder_ / "absent" / "volume.vdb", std::filesystem::path("/dev/full")}) {
        test::expect_input_error([&] { scene.write(path); }, {path.native()});
    }
}

}  // namespace
}  // namespace topple::vdb
