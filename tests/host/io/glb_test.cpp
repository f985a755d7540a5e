// SPDX-License-Identifier: MIT
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <map>

#include "files.h"
#include "io/voxel_mesh.h"
#include "io/write_glb.h"

namespace topple::io {
namespace {

using Cell = std::array<std::int32_t, 3>;

// Voxels of a box with a lump, a hole through it and single ones around that touch at edges only.
std::vector<Cell> lumpy(std::uint64_t seed) {
    test::Random random(seed);
    std::vector<Cell> out;
    for (std::int32_t i = -4; i < 5; ++i) {
        for (std::int32_t j = -3; j < 6; ++j) {
            for (std::int32_t k = 0; k < 7; ++k) {
                const bool hole = i == 1 && j == 2;
                if ((!hole && k < 3) || random.below(3) == 0) out.push_back({i, j, k});
            }
        }
    }
    return out;
}

// By the divergence theorem.
template <class Mesh>
double volume_of(const Mesh& mesh) {
    double six = 0;
    for (const auto& t : mesh.triangle) {
        const Vec3 &a = mesh.vertex[t[0]], &b = mesh.vertex[t[1]], &c = mesh.vertex[t[2]];
        six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return six / 6;
}

// Every edge is walked as often one way as the other: the surface has no gap.
void expect_closed(const TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    for (const auto& t : mesh.triangle) {
        for (std::size_t n = 0; n < 3; ++n) {
            const auto a = t[n], b = t[(n + 1) % 3];
            ASSERT_NE(a, b);
            balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    }
    for (const auto& [edge, count] : balance) ASSERT_EQ(count, 0);
}

TEST(VoxelMesh, encloses_its_voxels_without_a_gap) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const auto voxels = lumpy(seed);
        const TriangleMesh mesh = voxel_boundary(voxels);
        expect_closed(mesh);
        EXPECT_NEAR(volume_of(mesh), static_cast<double>(voxels.size()), 1e-9);
        for (const auto& t : mesh.triangle) {
            const Vec3 &a = mesh.vertex[t[0]], &b = mesh.vertex[t[1]], &c = mesh.vertex[t[2]];
            double area = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
                area += std::abs((b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]));
            }
            EXPECT_GT(area, 0);
        }
    }
}

TEST(VoxelMesh, merges_what_is_flat) {
    std::vector<Cell> box;
    for (std::int32_t i = 0; i < 30; ++i) {
        for (std::int32_t j = 0; j < 20; ++j) {
            for (std::int32_t k = 0; k < 10; ++k) box.push_back({i, j, k});
        }
    }
    const TriangleMesh mesh = voxel_boundary(box);
    EXPECT_EQ(mesh.vertex.size(), 8u);
    EXPECT_EQ(mesh.triangle.size(), 12u);
    EXPECT_DOUBLE_EQ(volume_of(mesh), 6000);
    EXPECT_TRUE(voxel_boundary({}).triangle.empty());
}

TEST(VoxelMesh, ends_faces_where_it_is_told_to) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const auto voxels = lumpy(seed);
        const TriangleMesh mesh = voxel_boundary(voxels, 2);
        expect_closed(mesh);
        EXPECT_NEAR(volume_of(mesh), static_cast<double>(voxels.size()), 1e-9);
        for (const auto& t : mesh.triangle) {
            for (std::size_t a = 0; a < 3; ++a) {
                const auto [low, high] =
                    std::minmax({mesh.vertex[t[0]][a], mesh.vertex[t[1]][a], mesh.vertex[t[2]][a]});
                EXPECT_LE(high - low, 2);
            }
        }
    }
}

class Glb : public test::Files {};

TEST_F(Glb, loads_again_with_names_colours_places_and_volumes) {
    std::vector<GlbNode> nodes{{"object 0", {150, 150, 150}, {}}, {"object 7", {255, 0, 51}, {}}};
    for (std::uint64_t n = 0; n < 2; ++n) {
        nodes[n].mesh = voxel_boundary(lumpy(n + 1));
        for (Vec3& v : nodes[n].mesh.vertex) {
            for (double& c : v) c *= 0.02;
        }
    }
    // z up to y up.
    write_glb(path("a.glb"), nodes, {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, -1, 0}});
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path("a.glb").string(), 0);
    ASSERT_TRUE(scene) << importer.GetErrorString();
    ASSERT_EQ(scene->mRootNode->mNumChildren, 2u);
    const aiVector3D up = aiMatrix3x3(scene->mRootNode->mTransformation) * aiVector3D(0, 0, 1);
    EXPECT_NEAR(up.y, 1, 1e-6);
    for (unsigned n = 0; n < 2; ++n) {
        const aiNode& node = *scene->mRootNode->mChildren[n];
        EXPECT_EQ(std::string(node.mName.C_Str()), nodes[n].name);
        ASSERT_EQ(node.mNumMeshes, 1u);
        const aiMesh& mesh = *scene->mMeshes[node.mMeshes[0]];
        TriangleMesh read;
        for (unsigned v = 0; v < mesh.mNumVertices; ++v)
            read.vertex.push_back({mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z});
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            ASSERT_EQ(mesh.mFaces[f].mNumIndices, 3u);
            const unsigned* i = mesh.mFaces[f].mIndices;
            read.triangle.push_back({i[0], i[1], i[2]});
        }
        expect_closed(read);
        const auto voxels = static_cast<double>(lumpy(n + 1).size());
        EXPECT_NEAR(volume_of(read), voxels * 8e-6, 1e-6 * voxels * 8e-6);
        aiColor4D colour;
        ASSERT_EQ(scene->mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_BASE_COLOR, colour),
                  aiReturn_SUCCESS);
        EXPECT_NEAR(colour.r, n == 0 ? 0.3050 : 1, 1e-3);
        EXPECT_NEAR(colour.b, n == 0 ? 0.3050 : 0.0331, 1e-3);
    }
}

}  // namespace
}  // namespace topple::io
