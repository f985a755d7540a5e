// SPDX-License-Identifier: MIT
#include "points/formats/mesh_colours.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <algorithm>
#include <cmath>

#include "core/colour_space.h"
#include "io/text.h"

namespace topple::io {
namespace {

using Rgb = std::array<double, 3>;

Rgb shares_of(const aiColor4D* colours, const MeshPlace& place) {
    Rgb out{};
    for (std::size_t n = 0; n < 3; ++n) {
        const aiColor4D& c = colours[place.vertex[n]];
        out[0] += place.share[n] * c.r;
        out[1] += place.share[n] * c.g;
        out[2] += place.share[n] * c.b;
    }
    return out;
}

// The image's nearest pixel, linear. glTF repeats images beyond their edges; assimp's v grows
// upwards.
Rgb texel(const ColourImage& image, double u, double v) {
    const auto along = [](double at, std::uint32_t size) {
        const double share = std::isfinite(at) ? at - std::floor(at) : 0;
        return std::min(static_cast<std::uint32_t>(share * size), size - 1);
    };
    const std::size_t at =
        3 * (std::size_t{along(1 - v, image.height)} * image.width + along(u, image.width));
    return {linear_of_srgb(image.rgb[at] / 255.0), linear_of_srgb(image.rgb[at + 1] / 255.0),
            linear_of_srgb(image.rgb[at + 2] / 255.0)};
}

}  // namespace

void MeshColours::look_at_material(const std::filesystem::path& file, const aiScene& scene,
                                   const aiMaterial& material) {
    Base base;
    aiColor4D factor;
    if (material.Get(AI_MATKEY_BASE_COLOR, factor) == aiReturn_SUCCESS)
        base.factor = {factor.r, factor.g, factor.b};
    any_ = any_ || base.factor != Rgb{1, 1, 1};
    aiString name;
    if (material.GetTexture(aiTextureType_BASE_COLOR, 0, &name) == aiReturn_SUCCESS) {
        const aiTexture* texture = scene.GetEmbeddedTexture(name.C_Str());
        // Without height it is a file in the file, of so many bytes.
        if (texture && texture->mHeight == 0) {
            try {
                base.image = decode_colour_image(
                    file, {reinterpret_cast<const char*>(texture->pcData), texture->mWidth});
            } catch (const Error& error) {
                notes_.push_back(std::string("An image in the mesh's file was left out: ") +
                                 error.what() + ".");
            }
        } else if (!texture) {
            notes_.push_back(
                "An image beside the mesh's file was left out: only those in it are read (.glb).");
        }
        any_ = any_ || !base.image.rgb.empty();
    }
    base_.push_back(std::move(base));
}

MeshColours::MeshColours(const std::filesystem::path& file, const aiScene& scene, MeshFormat format)
    : scene_(scene), linear_(format == MeshFormat::glb || format == MeshFormat::gltf) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        any_ = any_ || (format != MeshFormat::stl && scene.mMeshes[m]->HasVertexColors(0));
    if (!linear_) return;
    for (unsigned m = 0; m < scene.mNumMaterials; ++m)
        look_at_material(file, scene, *scene.mMaterials[m]);
}

std::array<double, 3> MeshColours::at(const MeshPlace& place) const {
    const aiMesh& mesh = *scene_.mMeshes[place.mesh];
    Rgb colour{1, 1, 1};
    if (mesh.HasVertexColors(0)) colour = shares_of(mesh.mColors[0], place);
    if (mesh.mMaterialIndex < base_.size()) {
        const Base& base = base_[mesh.mMaterialIndex];
        for (std::size_t c = 0; c < 3; ++c) colour[c] *= base.factor[c];
        if (!base.image.rgb.empty() && mesh.HasTextureCoords(0)) {
            double u = 0, v = 0;
            for (std::size_t n = 0; n < 3; ++n) {
                const aiVector3D& at = mesh.mTextureCoords[0][place.vertex[n]];
                u += place.share[n] * at.x;
                v += place.share[n] * at.y;
            }
            const Rgb of_image = texel(base.image, u, v);
            for (std::size_t c = 0; c < 3; ++c) colour[c] *= of_image[c];
        }
    }
    for (double& c : colour) c = 255 * (linear_ ? srgb_of_linear(std::clamp(c, 0.0, 1.0)) : c);
    return colour;
}

}  // namespace topple::io
