// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "geometry/pose_comparison.h"
#include "pipeline/scale_checks.h"
#include "topple/input.h"

// What of a depth camera is taken as it is given, and looks as if it meant something else: notes in
// sentences, each with the mend.
namespace topple {

// A principal point outside of the middle half of the image: left at 0, or of another image size.
void note_principal_point(const Intrinsics& intrinsics, ScanOrigin origin,
                          std::vector<std::string>& notes);

// One pose for frames that differ; poses in another convention, in which the frames agree where
// they don't as given; or frames that contradict each other in any; "": none of that. The frames
// were added.
std::string pose_note(const geometry::PoseComparison& frames, ScanOrigin origin);

}  // namespace topple
