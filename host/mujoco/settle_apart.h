// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>

#include "mujoco/settled.h"

namespace topple::mujoco {

// The program that runs MuJoCo, for topple itself is not linked with it. Throws Error(device) that
// says what to install where it is missing.
std::filesystem::path find_simulator();

// Runs a scene in it, in a process of its own with limits. patience_s: what that may take; a run
// that isn't done by then is told as far as it came. poll: called now and then; what it throws ends
// the run. Throws Error: device (no MuJoCo, or it crashed), input (it can't load the scene, or
// can't go on).
Settled settle_apart(const std::filesystem::path& file, double seconds, double patience_s,
                     const std::function<void()>& poll);

}  // namespace topple::mujoco
