// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "topple/scene.h"

namespace topple::io {

// Of a points.ply that topple wrote: coordinates, objects and the scan's own colours. No points
// where the file is missing, or where the scan has no colours. Throws Error(input) where it is
// damaged or another program's.
ScenePoints read_points_colours(const std::filesystem::path& file);

}  // namespace topple::io
