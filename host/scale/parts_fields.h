// SPDX-License-Identifier: MIT
#pragma once

#include "objects/found_parts.h"
#include "scale/binary_file.h"

// FoundParts as fields in a row, with what each must be: a file says anything.
namespace topple {

void write_parts(tiles::BinaryWriter& file, const FoundParts& ground);
// Throws Error(input) where it is none that a parse lays.
FoundParts read_parts(tiles::BinaryReader& file);

}  // namespace topple
