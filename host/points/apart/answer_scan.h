// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "core/space_map.h"

namespace topple::reader {

// In a child: the scan that `read` makes of the task's file, or why it can't, is the answer.
// unit: as unit_text() writes it.
void answer_scan(const std::string& unit, const std::filesystem::path& file,
                 const std::function<ScannedMap(const std::filesystem::path&, double)>& read);

// Exact: the child gets the same bits.
std::string unit_text(double unit_m);

}  // namespace topple::reader
