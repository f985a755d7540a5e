// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <limits>

#include "mujoco/settled.h"

// MuJoCo itself. Its header is kept out of all others.
namespace topple::mujoco {

// Runs a scene for so long, or until that took `patience_s`. Does not return where MuJoCo finds
// that it can't go on: that ends the process, after `on_error` was called where it is set.
Settled settle(const std::filesystem::path& file, double seconds,
               double patience_s = std::numeric_limits<double>::infinity(),
               void (*on_error)(const char* what) = nullptr);

}  // namespace topple::mujoco
