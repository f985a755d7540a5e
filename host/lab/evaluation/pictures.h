// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "lab/evaluation/room.h"

// The scores and one room as pictures. Each throws Error(input) where the file can't be written.
namespace topple::evaluation {

// Fig. 14: bars of the median errors, with the range over the rooms; left against true objects,
// right against true parts.
void draw_segmentation_chart(const std::vector<RoomScore>& rooms,
                             const std::filesystem::path& path);

// Table 2: precision against recall, a dot for each room, and the paper's three figures.
void draw_volume_chart(const std::vector<RoomScore>& rooms, const std::filesystem::path& path);

// The room's points from above, near walls and ceiling left out: true parts beside primitives, true
// objects beside objects. A found segment has the colour of the true one that it matches best, if
// it is the best match of that one, too; else a colour of its own.
void draw_segments(const Room& room, const std::filesystem::path& path);

// Cuts through the voxels along the room's three planes where most solids are: seen, filled and
// invisible voxels against the truth.
void draw_slices(const Room& room, const std::filesystem::path& path);

}  // namespace topple::evaluation
