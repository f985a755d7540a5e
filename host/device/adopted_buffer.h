// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "topple/kernels/device.h"

namespace topple::device {

// The caller's buffer as memory of the device: a cl_mem or VkBuffer of `bytes` bytes. It stays the
// caller's. Throws Error(device) on a backend that has no such buffers, and where OpenCL says that
// it is another size or of another context.
MemoryPtr adopt_buffer(Device& device, void* handle, std::uint64_t bytes, const std::string& name);

}  // namespace topple::device
