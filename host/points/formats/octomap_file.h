// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace topple::io {

// The largest depth of an OctoMap: its keys have 16 bits per axis.
constexpr int octomap_depth = 16;
constexpr std::int32_t octomap_middle = 1 << (octomap_depth - 1);  // the key of voxel 0

// An OctoMap file, its tree checked but not read.
struct OctomapFile {
    double resolution_m = 0;
    bool binary = false;    // .bt: nodes are free, occupied or unknown; else .ot: log-odds
    std::string_view tree;  // exactly the nodes' bytes
};

// Reads the header, and walks over the tree as it is stored: the library that reads it takes the
// tree's depth and length on trust. Throws Error(input).
OctomapFile open_octomap(const std::filesystem::path& file, std::string_view bytes);

}  // namespace topple::io
