// SPDX-License-Identifier: MIT
#pragma once

#include <assimp/scene.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "points/formats/colour_image.h"
#include "points/formats/read_mesh.h"

namespace topple::io {

// Where on a scene's mesh a point lies: the shares of three of its vertices.
struct MeshPlace {
    std::uint32_t mesh = 0;
    std::array<std::uint32_t, 3> vertex{};
    std::array<double, 3> share{};
};

// The colours of a mesh: those of its vertices, and of glTF also its materials' base colours and
// the images within the file, which multiply.
class MeshColours {
  public:
    // The scene must stay. Images that can't be read are left out and noted.
    MeshColours(const std::filesystem::path& file, const aiScene& scene, MeshFormat format);

    bool any() const { return any_; }
    std::array<double, 3> at(const MeshPlace& place) const;  // sRGB, 0 to 255
    const std::vector<std::string>& notes() const { return notes_; }

  private:
    void look_at_material(const std::filesystem::path& file, const aiScene& scene,
                          const aiMaterial& material);

    // Linear, as glTF has it.
    struct Base {
        std::array<double, 3> factor{1, 1, 1};
        ColourImage image;
    };
    const aiScene& scene_;
    bool linear_;             // whether vertices' colours are
    bool any_ = false;        // something has a colour that is not white for want of one
    std::vector<Base> base_;  // by material
    std::vector<std::string> notes_;
};

}  // namespace topple::io
