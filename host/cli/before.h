// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "topple/scene.h"

// What corrections changed of what was worst, for the summary on the terminal.
namespace topple::cli {

struct Worst {
    std::string text;          // "object 16 (bookcase), high, 16,000 J per earthquake"
    std::filesystem::path of;  // the scene.json that tells
};

// Of an earlier output; none where there is none that can be read.
std::optional<Worst> worst_of(const std::filesystem::path& output);

void print_change(const Worst& before, const Scene& now);

}  // namespace topple::cli
