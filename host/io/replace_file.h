// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

namespace topple::io {

// Writes a whole file in one step, by a temporary one beside it: an earlier file of that name is
// there until the new one is whole. Throws Error(input) where it can't be written.
void replace_file(const std::filesystem::path& file, std::string_view text);

// Throws Error(input) where there is a file of that name whose first kilobyte does not hold `mark`:
// it is another program's.
void check_own_file(const std::filesystem::path& file, std::string_view mark,
                    const char* what = "is no export of topple; choose another folder");

}  // namespace topple::io
