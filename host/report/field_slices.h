// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "topple/scene.h"
#include "topple/space_field.h"

namespace topple::report {

// Draws each field over space in which anything flows as field-NAME.png: level slices at the
// heights of shins, hands and heads, how much passes as colour and its mean velocity as lines
// (paper, Fig. 11). Throws Error(input) where a file can't be written.
void write_field_slices(const std::filesystem::path& folder,
                        const std::map<std::string, SpaceField>& fields, const Scene& scene);

}  // namespace topple::report
