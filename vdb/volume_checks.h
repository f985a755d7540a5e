// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

namespace topple::io {

// Walks over what an OpenVDB file says before its voxels, as OpenVDB takes that on trust: the
// magic number, the version, counts and lengths, where its grids lie, and how many nodes the roots
// of their trees have. Throws Error(input) where something of it goes beyond the file's `bytes`.
void check_volume(const std::filesystem::path& file, std::string_view bytes);

}  // namespace topple::io
