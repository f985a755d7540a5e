// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "topple/parse.h"

namespace topple::cli {

// From now on the system gives this process no more than what a parse of the input may take, so
// that what grows between two looks at it ends, too, as memory that ran out.
void keep_to_budget(const std::string& input, const ParseOptions& options);

}  // namespace topple::cli
