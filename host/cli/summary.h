// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "topple/scene.h"

namespace topple::cli {

// Prints what was found, the objects most at risk first, and where the report lies.
void print_summary(const Scene& scene, const std::filesystem::path& out);

}  // namespace topple::cli
