// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "topple/export.h"

namespace topple::exports {

// bodies.json, schema "topple.bodies/1": what became of each object, beside every export. A number
// that is not finite is written as null.
std::string bodies_json(const ExportSummary& summary);

inline constexpr const char* bodies_schema = "topple.bodies/1";

}  // namespace topple::exports
