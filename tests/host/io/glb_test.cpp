// SPDX-License-Identifier: MIT
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>

#include "files.h"
#include "result/write_glb.h"

namespace topple::io {
namespace {

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

// A box of which the corners come three times, once for each of its faces' normals.
GlbMesh box(const Vec3& low, const Vec3& size) {
    GlbMesh out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool upper : {false, true}) {
            const auto first = static_cast<std::uint32_t>(out.vertex.size());
            for (const auto& [u, v] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
                Vec3 at = low, normal{};
                at[axis] += upper ? size[axis] : 0;
                at[(axis + 1) % 3] += u * size[(axis + 1) % 3];
                at[(axis + 2) % 3] += v * size[(axis + 2) % 3];
                normal[axis] = upper ? 1 : -1;
                out.vertex.push_back(at);
                out.normal.push_back(normal);
            }
            const std::uint32_t b = upper ? 1 : 3, d = upper ? 3 : 1;
            out.triangle.push_back({first, first + b, first + 2});
            out.triangle.push_back({first, first + 2, first + d});
        }
    }
    return out;
}

class Glb : public test::Files {};

TEST_F(Glb, loads_again_with_names_colours_places_and_volumes) {
    std::vector<GlbNode> nodes{{"object 0", {150, 150, 150}, box({-0.1, 0.2, 0.3}, {0.25, 0.5, 1})},
                               {"object 7", {255, 0, 51}, box({1, 2, 3}, {0.5, 0.125, 0.25})}};
    nodes[1].mesh.normal.clear();
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
        GlbMesh read;
        for (unsigned v = 0; v < mesh.mNumVertices; ++v)
            read.vertex.push_back({mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z});
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            ASSERT_EQ(mesh.mFaces[f].mNumIndices, 3u);
            const unsigned* i = mesh.mFaces[f].mIndices;
            read.triangle.push_back({i[0], i[1], i[2]});
        }
        EXPECT_NEAR(volume_of(read), n == 0 ? 0.125 : 0.015625, 1e-6);
        ASSERT_EQ(mesh.HasNormals(), n == 0);
        for (unsigned v = 0; n == 0 && v < mesh.mNumVertices; ++v) {
            const Vec3& normal = nodes[0].mesh.normal.at(v);
            EXPECT_EQ(mesh.mNormals[v].x, static_cast<float>(normal[0]));
            EXPECT_EQ(mesh.mNormals[v].z, static_cast<float>(normal[2]));
        }
        aiColor4D colour;
        ASSERT_EQ(scene->mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_BASE_COLOR, colour),
                  aiReturn_SUCCESS);
        EXPECT_NEAR(colour.r, n == 0 ? 0.3050 : 1, 1e-3);
        EXPECT_NEAR(colour.b, n == 0 ? 0.3050 : 0.0331, 1e-3);
    }
}

}  // namespace
}  // namespace topple::io
