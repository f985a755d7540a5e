// SPDX-License-Identifier: MIT
#pragma once

#include "objects/groundwork.h"
#include "scale/binary_file.h"

// Groundwork as fields in a row, with what each must be: a file says anything.
namespace topple {

void write_groundwork(tiles::BinaryWriter& file, const Groundwork& ground);
// Throws Error(input) where it is none that a parse lays.
Groundwork read_groundwork(tiles::BinaryReader& file);

}  // namespace topple
