// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "topple/device.h"

namespace topple::device {

// A backend's devices, OpenCL's or Vulkan's, as a process of its own finds them: a driver that ends
// the process that tries it, or hangs for 30 s, is one that can't be used, and its listing says
// why. Nothing of the drivers is loaded into this process. Where there is no topple-reader they are
// listed here. A probe that went well is not made again in this process.
std::vector<Listing> probe(Backend backend);

// In that process: lists the devices of a backend, "opencl" or "vulkan", as its answer.
void answer_probe(const std::string& backend);

}  // namespace topple::device
