// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "topple/space_field.h"

namespace topple::vdb {

// Writes fields over space as an OpenVDB file: of each, called NAME, grids NAME_velocity (Vec3f, in
// the input's frame), NAME_frequency and NAME_energy (float), active where the field is not 0. The
// transform takes the index (i, j, k) to the cell's middle in the input's frame. Throws
// Error(input) where the file can't be written.
void write_space_fields(const std::filesystem::path& path,
                        const std::map<std::string, SpaceField>& fields);

}  // namespace topple::vdb
