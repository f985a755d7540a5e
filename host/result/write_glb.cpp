// SPDX-License-Identifier: MIT
#include "result/write_glb.h"

#include <assimp/GltfMaterial.h>
#include <assimp/scene.h>

#include <assimp/Exporter.hpp>

#include "core/colour_space.h"
#include "io/file_writer.h"
#include "io/text.h"

// assimp's scenes own what their pointers show; until a scene is whole, it is filled from above, so
// that nothing is lost where memory ends.
namespace topple::io {
namespace {

// glTF's colours are linear.
aiColor4D linear(const Rgb8& srgb) {
    const auto channel = [](std::uint8_t v) {
        return static_cast<float>(linear_of_srgb(v / 255.0));
    };
    return {channel(srgb[0]), channel(srgb[1]), channel(srgb[2]), 1};
}

aiMaterial* material_of(const GlbNode& node) {
    auto* material = new aiMaterial;
    const aiColor4D colour =
        node.vertex_colour.empty() ? linear(node.colour) : aiColor4D(1, 1, 1, 1);
    const aiString name(node.name);
    const float metallic = 0, roughness = 1;
    material->AddProperty(&name, AI_MATKEY_NAME);
    material->AddProperty(&colour, 1, AI_MATKEY_BASE_COLOR);
    material->AddProperty(&colour, 1, AI_MATKEY_COLOR_DIFFUSE);
    material->AddProperty(&metallic, 1, AI_MATKEY_METALLIC_FACTOR);
    material->AddProperty(&roughness, 1, AI_MATKEY_ROUGHNESS_FACTOR);
    return material;
}

aiVector3D* vectors_of(const std::vector<Vec3>& from) {
    auto* out = new aiVector3D[from.size()];
    for (std::size_t n = 0; n < from.size(); ++n) {
        out[n] = {static_cast<float>(from[n][0]), static_cast<float>(from[n][1]),
                  static_cast<float>(from[n][2])};
    }
    return out;
}

aiMesh* mesh_of(const GlbNode& node, unsigned material) {
    auto* mesh = new aiMesh;
    mesh->mName = node.name;
    mesh->mMaterialIndex = material;
    mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
    mesh->mNumVertices = static_cast<unsigned>(node.mesh.vertex.size());
    mesh->mVertices = vectors_of(node.mesh.vertex);
    if (!node.mesh.normal.empty()) mesh->mNormals = vectors_of(node.mesh.normal);
    if (!node.vertex_colour.empty()) {
        mesh->mColors[0] = new aiColor4D[mesh->mNumVertices];
        for (unsigned n = 0; n < mesh->mNumVertices; ++n)
            mesh->mColors[0][n] = linear(node.vertex_colour.at(n));
    }
    mesh->mNumFaces = static_cast<unsigned>(node.mesh.triangle.size());
    mesh->mFaces = new aiFace[mesh->mNumFaces];
    for (unsigned n = 0; n < mesh->mNumFaces; ++n) {
        aiFace& face = mesh->mFaces[n];
        face.mNumIndices = 3;
        face.mIndices = new unsigned[3];
        for (unsigned c = 0; c < 3; ++c) face.mIndices[c] = node.mesh.triangle[n][c];
    }
    return mesh;
}

void fill(aiScene& scene, const std::vector<GlbNode>& nodes, const std::array<Vec3, 3>& turn) {
    const auto count = static_cast<unsigned>(nodes.size());
    scene.mRootNode = new aiNode("topple");
    aiMatrix4x4& m = scene.mRootNode->mTransformation;
    for (unsigned row = 0; row < 3; ++row) {
        for (unsigned column = 0; column < 3; ++column)
            m[row][column] = static_cast<float>(turn[row][column]);
    }
    scene.mMaterials = new aiMaterial*[count]();
    scene.mNumMaterials = count;
    scene.mMeshes = new aiMesh*[count]();
    scene.mNumMeshes = count;
    scene.mRootNode->mChildren = new aiNode*[count]();
    scene.mRootNode->mNumChildren = count;
    for (unsigned n = 0; n < count; ++n) {
        scene.mMaterials[n] = material_of(nodes[n]);
        scene.mMeshes[n] = mesh_of(nodes[n], n);
        auto* node = scene.mRootNode->mChildren[n] = new aiNode(nodes[n].name);
        node->mParent = scene.mRootNode;
        node->mMeshes = new unsigned[1]{n};
        node->mNumMeshes = 1;
    }
}

}  // namespace

void write_glb(const std::filesystem::path& file, const std::vector<GlbNode>& nodes,
               const std::array<Vec3, 3>& y_up_from_input) {
    aiScene scene;
    fill(scene, nodes, y_up_from_input);
    Assimp::Exporter exporter;
    const aiExportDataBlob* blob = exporter.ExportToBlob(&scene, "glb2");
    if (!blob || !blob->data)
        fail(file, "can't be written: " + printable(exporter.GetErrorString(), 200));
    FileWriter writer(file);
    writer.write(blob->data, blob->size);
    writer.close();
}

}  // namespace topple::io
