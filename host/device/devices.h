// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device/device.h"

// Finding and opening devices.
namespace topple::device {

// A device that can be opened, or the reason why a backend offers none.
struct Listing {
    Backend backend = Backend::native;
    bool usable = false;
    DeviceInfo info;      // where usable
    std::string problem;  // where not: why, and what would mend it
};

// Every device of every backend, in the order native, OpenCL, Vulkan.
std::vector<Listing> list_devices();
std::vector<Listing> list_native();
std::vector<Listing> list_opencl();
std::vector<Listing> list_vulkan();

// What `--backend` takes: "auto" (a real GPU if there is one, else native), "native", "opencl",
// "vulkan". `threads` bounds the native backend's threads (0: all cores).
// Throws Error(usage) for an unknown name, Error(device) where the backend can't be used.
std::unique_ptr<Device> open_device(const std::string& backend, unsigned threads = 0);

// These take the best device of their backend: a GPU before a CPU, then in the driver's order.
std::unique_ptr<Device> open_native(unsigned threads = 0);
std::unique_ptr<Device> open_opencl();
std::unique_ptr<Device> open_vulkan();

}  // namespace topple::device
