// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "topple/compare.h"

namespace topple::comparing {

// The schema topple.comparison/1 of docs/output.md.
std::string comparison_json(const Comparison& found);

}  // namespace topple::comparing
