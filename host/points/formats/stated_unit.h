// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "topple/input.h"

namespace topple::io {

// The unit of a file's coordinates, where the file says what it is.
struct StatedUnit {
    Vec3 metres{1, 1, 1};  // of one, along x, y and z
    std::string by;        // "GeoKey 3076", "its header": where it stands
};

// Of a LAS file: by its GeoKeys 3076 (ProjLinearUnits; 3077 of a unit of its own) and 4099
// (VerticalUnits), or its WKT; where it has one for the ground or for heights only, the other is
// taken to be the same. Throws Error(input) where its coordinates are degrees.
std::optional<StatedUnit> unit_of_las(const std::filesystem::path& file, std::string_view bytes);

// Of a header that holds "unit: mm", "UNITS=inch", "units are metres" and the like.
std::optional<StatedUnit> unit_in_head(std::string_view head);
// Of a text by the names of its columns: "x [mm]".
std::optional<StatedUnit> unit_of_names(std::string_view text);
// The comments among the lines that a PLY, an OBJ or a text begins with.
std::string leading_comments(std::string_view bytes);

// What is to be said of a unit that was taken; "" of metres.
std::string unit_note(const StatedUnit& unit);

}  // namespace topple::io
