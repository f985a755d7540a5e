// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace topple {

// Whether what somebody called a thing has these words, given in small letters, as one or several:
// "Coffee mugs, left" has "mug" and "coffee mug".
bool name_has(std::string_view name, std::string_view words);

}  // namespace topple
