// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "topple/corrections.h"

namespace topple {

// The number, from 1 on, of what somebody said by each correction. One sentence about several parts
// may take several entries of the file, one after the other: they share their line `was`, and are
// of one kind and value at other spots, or `apart` after `one_thing`.
std::vector<std::size_t> told_sentences(std::span<const AppliedCorrection> corrections);

}  // namespace topple
