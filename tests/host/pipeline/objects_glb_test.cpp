// SPDX-License-Identifier: MIT
#include "export/objects_glb.h"

#include <assimp/scene.h>

#include <assimp/Importer.hpp>

#include "device/devices.h"
#include "export/object_surfaces.h"
#include "host/pipeline/scan.h"
#include "host/pipeline/small_room.h"
#include "host/solids/boxes.h"
#include "objects/object_boxes.h"
#include "solids/boundary.h"
#include "topple/object_at.h"

namespace topple {
namespace {

// Every edge is walked as often one way as the other, where vertices in one place are one.
void expect_closed(const aiMesh& mesh) {
    using Place = std::array<float, 3>;
    std::map<std::pair<Place, Place>, int> balance;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        for (unsigned n = 0; n < 3; ++n) {
            const auto place = [&](unsigned corner) {
                const aiVector3D& v = mesh.mVertices[mesh.mFaces[f].mIndices[corner % 3]];
                return Place{v.x, v.y, v.z};
            };
            const Place a = place(n), b = place(n + 1);
            balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    }
    for (const auto& [edge, count] : balance) ASSERT_EQ(count, 0);
}

class ObjectsGlb : public test::Files {
  protected:
    // What another program finds in the scene's objects.glb.
    const aiScene* written(const Scene& scene, const vdb::VoxelScene& voxels) {
        const vdb::VoxelFrame frame = voxels.frame();
        const auto surfaces = object_surfaces(scene, voxels.solid_cells(), {}, frame, 1);
        write_objects_glb(path("objects.glb"), scene, surfaces, frame);
        const aiScene* read = importer_.ReadFile(path("objects.glb").string(), 0);
        if (!read) throw std::runtime_error(importer_.GetErrorString());
        return read;
    }

  private:
    Assimp::Importer importer_;
};

// Two blocks of voxels and a fragment, on a grid that is turned and whose up is the input's -y.
TEST_F(ObjectsGlb, each_object_is_a_closed_mesh_around_its_voxels) {
    const double c = std::cos(0.3), s = std::sin(0.3), h = 0.04;
    const vdb::VoxelFrame frame{h, {Vec3{c, 0, s}, Vec3{-s, 0, c}, Vec3{0, -1, 0}}};
    PointCloud cloud;
    std::vector<std::int32_t> label;
    const auto block = [&](std::int32_t primitive, std::array<int, 3> low,
                           std::array<int, 3> size) {
        for (int n = 0; n < size[0] * size[1] * size[2]; ++n) {
            const std::array<double, 3> at{low[0] + n % size[0] + 0.5,
                                           low[1] + n / size[0] % size[1] + 0.5,
                                           low[2] + n / size[0] / size[1] + 0.5};
            const auto& r = frame.grid_from_input;
            const auto along = [&](std::size_t d) {
                return static_cast<float>(h *
                                          (r[0][d] * at[0] + r[1][d] * at[1] + r[2][d] * at[2]));
            };
            test::add(cloud, along(0), along(1), along(2));
            label.push_back(primitive);
        }
    };
    block(0, {-5, -5, -1}, {20, 20, 1});
    block(1, {0, 0, 0}, {4, 3, 10});
    block(2, {0, 0, 10}, {4, 3, 2});
    block(-1, {9, 9, 5}, {1, 1, 1});
    const vdb::VoxelScene voxels(frame, cloud, label);
    Scene scene;
    scene.primitives.resize(3);
    scene.objects.resize(2);
    scene.primitives[0].object = 0;
    scene.primitives[1].object = scene.primitives[2].object = 1;
    scene.objects[0].grounded = true;
    scene.objects[1].unsafety = 10;
    const aiScene* read = written(scene, voxels);
    const struct {
        const char* name;
        double voxels, least, red, green;
    } expected[] = {{"unassigned", 1, 0.25, 0.305, 0.305},
                    {"object 0", 400, 0.85, 0.305, 0.305},
                    {"object 1", 144, 0.85, 0.162, 0.003}};
    ASSERT_EQ(read->mRootNode->mNumChildren, std::size(expected));
    const aiMatrix3x3 turn(read->mRootNode->mTransformation);
    EXPECT_NEAR((turn * aiVector3D(0, -1, 0)).y, 1, 1e-6) << "up becomes y";
    for (unsigned n = 0; n < std::size(expected); ++n) {
        const auto& e = expected[n];
        SCOPED_TRACE(e.name);
        const aiNode& node = *read->mRootNode->mChildren[n];
        EXPECT_EQ(std::string(node.mName.C_Str()), e.name);
        const aiMesh& mesh = *read->mMeshes[node.mMeshes[0]];
        double volume = 0;
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const unsigned* i = mesh.mFaces[f].mIndices;
            const aiVector3D &p = mesh.mVertices[i[0]], &q = mesh.mVertices[i[1]];
            volume += double(p * (q ^ mesh.mVertices[i[2]])) / 6;
        }
        // Nothing is known within voxels: corners are rounded.
        EXPECT_GT(volume, e.least * e.voxels * h * h * h);
        EXPECT_LT(volume, 1.05 * e.voxels * h * h * h);
        expect_closed(mesh);
        aiColor4D colour;
        ASSERT_EQ(read->mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_BASE_COLOR, colour),
                  aiReturn_SUCCESS);
        EXPECT_NEAR(colour.r, e.red, 2e-3);
        EXPECT_NEAR(colour.g, e.green, 2e-3);
    }
}

// A row of voxels whose near end was seen red, its far end blue, and its middle not at all; beside
// it another object, of no known colour.
TEST_F(ObjectsGlb, colours_are_the_scans_where_it_has_any) {
    const vdb::VoxelFrame frame{0.1, {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}};
    PointCloud cloud;
    std::vector<std::int32_t> label;
    Scene scene;
    for (int i = 0; i < 9; ++i) {
        for (const int j : {0, 1}) {
            test::add(cloud, 0.1f * static_cast<float>(i) + 0.05f, j == 0 ? 0.05f : 0.15f, 0.05f);
            label.push_back(j);
            scene.points.object.push_back(j);
            scene.points.red.push_back(j == 0 && i < 2 ? 200 : 0);
            scene.points.green.push_back(0);
            scene.points.blue.push_back(j == 0 && i > 6 ? 200 : 0);
        }
    }
    scene.points.x = cloud.x;
    scene.points.y = cloud.y;
    scene.points.z = cloud.z;
    const vdb::VoxelScene voxels(frame, cloud, label);
    scene.primitives.resize(2);
    scene.objects.resize(2);
    scene.primitives[0].object = 0;
    scene.primitives[1].object = 1;
    scene.objects[1].unsafety = 10;
    const aiScene* read = written(scene, voxels);
    ASSERT_EQ(read->mRootNode->mNumChildren, 2u);
    const aiMesh& row = *read->mMeshes[read->mRootNode->mChildren[0]->mMeshes[0]];
    ASSERT_TRUE(row.HasVertexColors(0));
    constexpr float linear = 0.5776f;  // of 200
    for (unsigned v = 0; v < row.mNumVertices; ++v) {
        const float x = row.mVertices[v].x;
        if (x < 0.35f) {
            EXPECT_NEAR(row.mColors[0][v].r, linear, 1e-3) << x;
        }
        if (x > 0.55f) {
            EXPECT_NEAR(row.mColors[0][v].b, linear, 1e-3) << x;
        }
    }
    const aiMesh& other = *read->mMeshes[read->mRootNode->mChildren[1]->mMeshes[0]];
    ASSERT_TRUE(other.HasVertexColors(0));
    EXPECT_NEAR(other.mColors[0][0].r, 0.162, 2e-3) << "by unsafety";
}

}  // namespace
}  // namespace topple

// From a place to the object there.
namespace topple::test {
namespace {

ParseResult three_points() {
    ParseResult result;
    result.scene.points.x = {0, 1, 3, 2};
    result.scene.points.y = result.scene.points.z = {0, 0, 0, 0};
    result.scene.points.object = {4, 7, 7, -1};
    return result;
}

TEST(ObjectAt, IsThatOfTheNearestPointOfOne) {
    const ParseResult result = three_points();
    EXPECT_EQ(object_at(result, {0.4, 0, 0}, 0.5), 4);
    EXPECT_EQ(object_at(result, {0.5, 0, 0}, 0.5), 4) << "of two as near the earlier";
    EXPECT_EQ(object_at(result, {0.6, 0, 0}, 0.5), 7);
    EXPECT_EQ(object_at(result, {2, 0, 0}, 1), 7) << "what belongs to nothing doesn't count";
    EXPECT_EQ(object_at(result, {0, 0.3, 0.4}, 0.5), 4);
    EXPECT_EQ(object_at(result, {0, 0.3, 0.4}, 0.49), -1);
    EXPECT_EQ(object_at(result, {0, 0, 0}, 0), 4);
    EXPECT_EQ(object_at(result, {1e9, 0, 0}, INFINITY), 7);
    EXPECT_EQ(object_at(ParseResult{}, {0, 0, 0}, INFINITY), -1);
}

std::string refusal_at(const ParseResult& result, const Vec3& place, double within_m) {
    return message_of([&] { object_at(result, place, within_m); }, ErrorKind::usage);
}

TEST(ObjectAt, RefusesWhatMakesNoSense) {
    ParseResult result = three_points();
    EXPECT_EQ(
        refusal_at(result, {0, NAN, 0}, 1),
        "object_at: place_m (0, nan, 0): expected metres in the frame of the result's points, "
        "all finite");
    EXPECT_EQ(refusal_at(result, {0, 0, 0}, -1),
              "object_at: within_m -1: expected metres from 0 on");
    EXPECT_THAT(refusal_at(result, {0, 0, 0}, NAN), testing::HasSubstr("within_m nan"));
    result.scene.points.x.clear();
    EXPECT_THAT(refusal_at(result, {0, 0, 0}, 1), testing::HasSubstr("add_coordinates()"));
}

TEST_F(ParsedRoom, HasItsObjectsInTheirPlaces) {
    const auto at = [](const Vec3& place) { return object_at(result(), place, 0.05); };
    const std::int32_t floor = at({0.4, 0.4, 0}), crate = at({1.05, 0.95, 0.5}),
                       box = at({1.3, 1.2, 0.85});
    ASSERT_GE(std::min({floor, crate, box}), 0);
    EXPECT_TRUE(result().scene.objects[floor].grounded);
    EXPECT_NE(crate, floor);
    EXPECT_NE(box, crate);
    EXPECT_EQ(at({1.3, 1.2, 1.2}), -1) << "in the air";
}

}  // namespace
}  // namespace topple::test

namespace topple {
namespace {

// Two boxes that follow the grid and stand anywhere on it, of which all sides were seen.
TEST(ObjectBoxes, reach_from_surface_to_surface) {
    constexpr double voxel = 0.02;
    const auto device = device::open_native();
    for (const double shift : {0.0, 0.0037, 0.0113}) {
        SCOPED_TRACE(shift);
        const std::vector<solids::Box> boxes{{{0.31 + shift, -0.2, 0.5}, {0.05, 0.08, 0.12}},
                                             {{0.8, -0.2 + shift, 0.5}, {0.03, 0.05, 0.04}}};
        const solids::Scanned scanned = solids::scan(boxes, voxel);
        BoundaryCells boundary = solids::find_boundary(*device, scanned.cells, scanned.seen(),
                                                       scanned.patches, {false, false});
        const std::vector<std::int32_t> own{0, 1}, one{0, 0};
        const SolidScene solids(scanned.cells, {Role::none, Role::none}, {}, boundary);
        const std::vector<ObjectBox> found = object_boxes(solids, own, 2);
        for (std::size_t o = 0; o < 2; ++o) {
            for (std::size_t a = 0; a < 3; ++a) {
                const auto axis = static_cast<int>(a);
                EXPECT_NEAR(found[o].size_m[a], 2 * boxes[o].half[axis], 1e-4)
                    << "box " << o << ", axis " << a;
                EXPECT_NEAR(found[o].middle_m[a], boxes[o].middle[axis], 1e-4)
                    << "box " << o << ", axis " << a;
            }
            EXPECT_NEAR(found[o].top_m(), boxes[o].middle[2] + boxes[o].half[2], 1e-4);
        }
        const ObjectBox both = object_boxes(solids, one, 1)[0];
        EXPECT_NEAR(both.size_m[0], 0.8 + 0.03 - (0.31 + shift - 0.05), 1e-4);
        EXPECT_NEAR(both.middle_m[0], (0.8 + 0.03 + 0.31 + shift - 0.05) / 2, 1e-4);
        // Where nothing is known within voxels they count whole.
        const SolidScene coarse(scanned.cells, {Role::none, Role::none});
        const Vec3 whole = object_boxes(coarse, own, 2)[0].size_m;
        for (std::size_t a = 0; a < 3; ++a) {
            EXPECT_GE(whole[a], 2 * boxes[0].half[static_cast<int>(a)]);
            EXPECT_LE(whole[a], 2 * boxes[0].half[static_cast<int>(a)] + 2.01 * voxel);
        }
        const ObjectBox nothing = object_boxes(solids, own, 3)[2];  // an object without voxels
        EXPECT_EQ(nothing.size_m, Vec3{});
        EXPECT_TRUE(std::isnan(nothing.middle_m[0]));
    }
}

}  // namespace
}  // namespace topple
