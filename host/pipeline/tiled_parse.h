// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "topple/parse.h"

namespace topple {

// Blocks hold at least a table, and their halos.
inline constexpr double least_tile_m = 2;

// Parses a cloud file in blocks, if it is so large or options.tile_m asks for it: its points are
// sorted into cubes on disk and thinned there to one a cell; each block with its halo goes through
// section 2 of the paper; the primitives are joined across borders, and sections 3 to 5 see the
// whole. The result depends on the cloud and the options, not on memory, threads or on who parsed
// which block. Nothing: the input is no large cloud file, and nothing was done.
std::optional<ParseResult> parse_tiled(const std::filesystem::path& input,
                                       const ParseOptions& options);

}  // namespace topple
