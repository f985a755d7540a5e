// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace topple::io {

// The shapes of a glTF that check_gltf() took as a GLB whose accessors are as the library that
// reads meshes takes all of them to be: of floats, but for indices, and none of them sparse. None
// where they are so already. Skins, animations and targets are left out. bytes: the whole file.
// Throws Error(input) where data is not where the file says.
std::optional<std::string> plain_gltf(const std::filesystem::path& file, std::string_view bytes,
                                      bool glb);

}  // namespace topple::io
