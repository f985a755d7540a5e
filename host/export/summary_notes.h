// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "topple/export.h"

namespace topple::exports {

// What is not as it was parsed, in sentences: footings that were made up, and bodies that were cut
// to half or less.
std::vector<std::string> notes_of(const ExportSummary& summary);

}  // namespace topple::exports
