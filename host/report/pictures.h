// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "topple/scene.h"

namespace topple::report {

// Draws the report's main views without a display: view-parts.png, view-completed.png,
// view-objects.png and view-risk.png, and of
// what the scene has view-walks.png, view-human.png, view-wind.png, view-earthquake.png and
// view-reach.png. The same scene gives the same bytes. Throws Error(input) where a file can't be
// written.
void write_pictures(const std::filesystem::path& folder, const Scene& scene);

}  // namespace topple::report
