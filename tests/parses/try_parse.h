// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"
#include "topple/device.h"

namespace topple::parses {

// Parses random_scene(seed, small) on a device, and writes its outputs where `folder` is not empty.
// It may be refused, by an Error of one printable line; else the result is sound (invariants.h).
// What else happens is returned in words.
std::string try_parse(std::uint64_t seed, const std::shared_ptr<device::Device>& device,
                      const std::filesystem::path& folder = {}, bool small = false);

}  // namespace topple::parses
