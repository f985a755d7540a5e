// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

namespace topple::exports {

// Stands in a comment at the beginning of every export's file, so that an earlier one is known.
inline constexpr std::string_view export_mark = "topple export";

// Throws Error(input) where the file is there and is no export of ours.
void check_export_file(const std::filesystem::path& file);

// Writes it in one step, and the folder that it lies in where that is missing. Throws Error(input):
// another program's file is there, or it can't be written.
void write_export(const std::filesystem::path& file, std::string_view text);

}  // namespace topple::exports
