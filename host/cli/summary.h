// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "topple/scene.h"

namespace topple::cli {

// What was worst in an earlier output.
struct Worst {
    std::string text;          // "object 16 (bookcase), high, 16,000 J per earthquake"
    std::filesystem::path of;  // the scene.json that tells
};

// Of an earlier output; none where there is none that can be read.
std::optional<Worst> worst_of(const std::filesystem::path& output);

// Prints what was found, the objects most at risk first, the time that it took, of which output_s
// was for writing it, and where the report lies.
void print_summary(const Scene& scene, const std::filesystem::path& out, double output_s,
                   const std::optional<Worst>& before);

}  // namespace topple::cli
