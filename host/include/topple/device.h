// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

// What a parse runs on: listing devices and opening one. topple/embed.h adopts one instead that the
// caller has already.
namespace topple::device {

enum class Backend : std::uint8_t { native, opencl, vulkan };
// "native", "opencl" or "vulkan".
const char* to_string(Backend backend);

struct Limits {
    std::uint64_t max_binding_bytes = 0;     // largest range that one kernel binding may span
    std::uint64_t max_allocation_bytes = 0;  // largest single allocation
    std::uint64_t memory_bytes = 0;          // all memory of the device
    std::uint32_t max_group_size = 0;
    std::uint32_t shared_bytes = 0;  // per work-group
};

struct DeviceInfo {
    Backend backend = Backend::native;
    std::string name;
    std::string driver;  // driver or platform name and version
    bool gpu = false;    // a real GPU, not a CPU behind a GPU's interface
    Limits limits;
};

// A device that can be opened, or the reason why a backend offers none.
struct Listing {
    Backend backend = Backend::native;
    bool usable = false;
    DeviceInfo info;      // where usable
    std::string problem;  // where not: why, and what would mend it
};

// Every device of every backend, in the order native, OpenCL, Vulkan. A backend that is missing is
// listed with its problem, not thrown.
std::vector<Listing> list_devices();

// An open device, held by pointer only. Nothing behind it is global, so devices are independent of
// one another; each may be used from one thread at a time. It keeps the kernels that it has built:
// the second parse on a device starts sooner than the first.
class Device;

// What the device is; valid as long as the device.
const DeviceInfo& describe(const Device& device);

// Opens the best device of a backend: "native", "opencl" or "vulkan", a GPU before a CPU, then in
// the driver's order; or of all backends, with "auto": a real GPU if there is one, else native.
// `threads` bounds the native backend's threads (0: all cores). Throws Error: usage (an unknown
// backend), device (it can't be used: why, and what would mend it).
std::shared_ptr<Device> open_device(const std::string& backend = "auto", unsigned threads = 0);

}  // namespace topple::device
