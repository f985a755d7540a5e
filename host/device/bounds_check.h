// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "topple/kernels/device.h"

namespace topple::device {

// Whether TOPPLE_CHECK=bounds is in the environment. Throws Error(usage) where it is something
// else.
bool bounds_check_wanted();

// Runs the checked forms of the batch's kernels, which access nothing outside of what is bound.
// Throws Error(device) with the first such access of the first dispatch that has one, and where a
// kernel has no checked form.
void run_checked(Device& device, std::vector<Dispatch> batch);

}  // namespace topple::device
