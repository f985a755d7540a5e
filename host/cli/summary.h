// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "cli/before.h"
#include "topple/scene.h"

namespace topple::cli {

// Prints what was found, the objects most at risk first, the time that it took, of which output_s
// was for writing it, and where the report lies.
void print_summary(const Scene& scene, const std::filesystem::path& out, double output_s,
                   const std::optional<Worst>& before);

}  // namespace topple::cli
