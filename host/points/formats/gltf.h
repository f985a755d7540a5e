// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/json.h"
#include "io/open_file.h"

namespace topple::io {

// The JSON of a glTF. Throws Error(input) where it contradicts itself or its buffers, would take
// much more memory to read than a file of its size may, or names a file outside of its own folder:
//   - brackets nested 100 deep; nodes 256 deep, in a cycle, or with two parents, so that what they
//     hold would be there twice, four times, ...;
//   - views beyond their buffers and accessors beyond their views, by the size of their elements;
//   - a count of nodes, primitives, materials and the like, or data named by so many of them, of
//     which copies would take more than import_budget();
//   - a uri that is absolute, has a scheme or .., leads through a link out of the file's folder, or
//     to what is no regular file; in a GLB, any but data: for a buffer.
// text: the JSON. binary_bytes: of a GLB's second part; none: a .gltf.
Json checked_gltf(const std::filesystem::path& file, std::string_view text,
                  std::optional<std::uint64_t> binary_bytes);

// The file that `uri` names beside `file`; throws Error(input), with
// `file` in its message, where it is not there, or is not to be opened, as above.
FileName file_beside(const std::filesystem::path& file, std::string_view uri);

// The shapes of a glTF that checked_gltf() took as a GLB whose accessors are as the library that
// reads meshes takes all of them to be: of floats, but for indices, and none of them sparse. None
// where they are so already. Skins, animations and targets are left out. bytes: the whole file.
// Throws Error(input) where data is not where the file says.
std::optional<std::string> plain_gltf(const std::filesystem::path& file, std::string_view bytes,
                                      bool glb);

}  // namespace topple::io
