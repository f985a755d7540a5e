// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace topple {

// What the linker has named the program or library after that holds this code: another build of
// other code has another. Empty where it has not.
std::string build_id();

}  // namespace topple
