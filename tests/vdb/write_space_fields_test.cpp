// SPDX-License-Identifier: MIT
#include "vdb/write_space_fields.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include "host/io/files.h"

namespace topple::vdb {
namespace {

// As another program reads them: each value at its place in the input's frame.
class SpaceFields : public test::Files {};

TEST_F(SpaceFields, AreReadByOpenVdbWhereTheyAre) {
    openvdb::initialize();
    SpaceField field;
    field.corner_m = {1, 2, 3};
    field.along_m = {Vec3{0, 0.1, 0}, Vec3{-0.1, 0, 0}, Vec3{0, 0, 0.1}};  // a quarter turn
    field.cell = {{0, 0, 0}, {2, -1, 5}};
    field.velocity_m_s = {{0.5f, 0, 0}, {0, -1.5f, 0.25f}};
    field.frequency = {0.25f, 3};
    field.energy = {12, 0.5f};
    const std::filesystem::path file_path = path("fields.vdb");
    write_space_fields(file_path, {{"human", field}});
    openvdb::io::File file(file_path.string());
    file.open();
    const auto velocity = openvdb::gridPtrCast<openvdb::Vec3SGrid>(file.readGrid("human_velocity"));
    const auto frequency =
        openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("human_frequency"));
    const auto energy = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("human_energy"));
    EXPECT_EQ(velocity->activeVoxelCount(), 2u);
    const openvdb::Coord cell(2, -1, 5);
    EXPECT_EQ(velocity->tree().getValue(cell), openvdb::Vec3s(0, -1.5f, 0.25f));
    EXPECT_EQ(frequency->tree().getValue(cell), 3);
    EXPECT_EQ(energy->tree().getValue(cell), 0.5f);
    EXPECT_EQ(energy->metaValue<std::string>("unit"), "J");
    // Corner, two and a half cells along y, half a cell along x, five and a half up.
    const openvdb::Vec3d middle = frequency->transform().indexToWorld(cell);
    EXPECT_NEAR(middle.x(), 1 + 0.05, 1e-9);
    EXPECT_NEAR(middle.y(), 2 + 0.25, 1e-9);
    EXPECT_NEAR(middle.z(), 3.55, 1e-9);
}

}  // namespace
}  // namespace topple::vdb
