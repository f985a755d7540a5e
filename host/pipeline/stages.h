// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "device/stage_clock.h"
#include "objects/found_parts.h"
#include "points/observation.h"
#include "topple/kernels/device.h"
#include "topple/parse.h"

// The two halves of a parse in one piece. source: the input, as messages and the result name it.
namespace topple {

// Sections 2 and 4.2 of the paper: from points to solid primitives, where they touch, and how
// likely each two are one solid. Throws Error(input) where no surface is found.
FoundParts find_parts(device::Device& device, Observation input, const ParseOptions& options,
                      const std::string& source, StageClock& stage);

// Sections 3, 4.1 and 5: which primitives are one object, how each stands, and what may fall.
ParseResult judge_parts(device::Device& device, FoundParts found, const ParseOptions& options,
                        const std::string& source, StageClock& stage);

}  // namespace topple
