// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "topple/parse.h"

namespace topple {

// Clouds of more points are parsed in blocks: in one piece these take some 20 s and 2 GB.
inline constexpr std::uint64_t most_points_at_once = 4'000'000;

// The working resolution of a building, metres: furniture shows its shape, and a room has under a
// million cells, however dense the scan.
inline constexpr double building_cell_m = 0.0125;

// Voxels are about so many cells wide.
inline constexpr double voxel_cells = 2;

// Whether a file may hold so many: its points are streamed and counted then.
bool may_be_tiled(const std::filesystem::path& input, const ParseOptions& options);

// Parses a cloud file in blocks, if it is so large or options.tile_m asks for it: its points are
// sorted into cubes on disk and thinned there to one a cell; each block with its halo goes through
// section 2 of the paper; the primitives are joined across borders, and sections 3 to 5 see the
// whole. The result depends on the cloud and the options, not on memory, threads, tiles or on who
// parsed which block. Nothing: the input is no large cloud file, and nothing was done.
std::optional<ParseResult> parse_tiled(const std::filesystem::path& input,
                                       const ParseOptions& options);

// What an unfinished run of the same parse has left in options.work_folder.
struct WorkLeft {
    std::size_t done = 0, blocks = 0;  // blocks: 0 where it had not come to them
};

// "3 of 14 blocks".
std::string to_text(const WorkLeft& left);

// Nothing: the next run begins anew.
std::optional<WorkLeft> work_left(const std::filesystem::path& input, const ParseOptions& options);

}  // namespace topple
