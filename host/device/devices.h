// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "topple/kernels/device.h"

// Finding and opening the devices of one backend; topple/device.h does so for all.
namespace topple::device {

// What stands in the place of devices, or of one, that can't be used.
Listing unusable(Backend backend, const std::string& problem);
std::vector<Listing> list_native();
std::vector<Listing> list_opencl();
std::vector<Listing> list_vulkan();

// That of the entries which native devices run: of the widest instruction set that the CPU has.
NativeEntry best_entry(const NativeEntries& entries);

// These take the best device of their backend: a GPU before a CPU, then in the driver's order.
// Throw Error(device) where there is none that can be used.
std::unique_ptr<Device> open_native(unsigned threads = 0);
std::unique_ptr<Device> open_opencl();
std::unique_ptr<Device> open_vulkan();

}  // namespace topple::device
