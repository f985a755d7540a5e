// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "points/pose_comparison.h"
#include "points/scale_checks.h"
#include "topple/input.h"

// What of a depth camera is taken as it is given, and looks as if it meant something else: notes in
// sentences, each with the mend.
namespace topple {

// A principal point outside of the middle half of the image: left at 0, or of another image size.
void note_principal_point(const Intrinsics& intrinsics, ScanOrigin origin,
                          std::vector<std::string>& notes);

// Frames that contradict each other, or poses in another convention, in which they do not; "": none
// of that. All `count` frames were added.
std::string pose_note(const geometry::PoseComparison& frames, std::size_t count, ScanOrigin origin);

}  // namespace topple
