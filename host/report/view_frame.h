// SPDX-License-Identifier: MIT
#pragma once

#include "core/rotation.h"
#include "topple/scene.h"

namespace topple::report {

// The rotation from the input to the view: the scene's own frame where it has one with z up, else
// any with z up.
Rotation view_frame(const Scene& scene);

}  // namespace topple::report
