// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "child/process.h"
#include "topple/device.h"

namespace topple::device {

// A backend's devices, in this process: "opencl" or "vulkan".
std::vector<Listing> list_backend(const std::string& backend);

// Listings as a child's answer. take_listings() throws child::BadAnswer where it is none of
// `backend`.
void write_listings(const std::vector<Listing>& listings);
std::vector<Listing> take_listings(const child::Answer& answer, Backend backend);

}  // namespace topple::device
