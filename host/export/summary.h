// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "topple/export.h"

// What became of the objects in an export.
namespace topple::exports {

// What is not as it was parsed, in sentences: footings that were made up, and bodies that were cut
// to half or less.
std::vector<std::string> notes_of(const ExportSummary& summary);

// bodies.json, schema "topple.bodies/1": what became of each object, beside every export. A number
// that is not finite is written as null.
std::string bodies_json(const ExportSummary& summary);

inline constexpr const char* bodies_schema = "topple.bodies/1";

}  // namespace topple::exports
