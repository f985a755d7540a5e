// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "lab/evaluation/room.h"

namespace topple::evaluation {

// The paper's Fig. 14 of these rooms, as SVG: errors of true objects' segments by region growing
// alone, by primitives and by objects, medians.
std::string segmentation_picture(const std::vector<RoomScore>& rooms);

}  // namespace topple::evaluation
