// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "device/stage_clock.h"
#include "scale/blocks.h"
#include "scale/point_spill.h"
#include "topple/crew.h"
#include "topple/kernels/device.h"
#include "topple/parse.h"

// The two stages of a parse in blocks that a crew shares out: thinning of bins, and section 2 of
// the paper block by block. What is in the folder already is left as it is.
namespace topple {

// What the folder's contents depend on beside the input: part of its manifest.
std::string options_text(const ParseOptions& options);

// What both stages need.
struct SharedWork {
    Crew& crew;
    device::Device& device;
    const std::filesystem::path& folder;  // that all members see
    const std::string& manifest;          // of that folder
};

// The leader's.
void thin_bins(const SharedWork& shared, const tiles::SpilledPoints& points, double cell_m,
               StageClock& stage);
void parse_blocks(const SharedWork& shared, const tiles::SpilledPoints& points,
                  const tiles::Layout& layout, const ParseOptions& options, StageClock& stage);

std::vector<tiles::Bin> bins_of(const tiles::SpilledPoints& points);

}  // namespace topple
