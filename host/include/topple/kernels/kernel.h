// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace topple::device {

enum class Access : std::uint8_t { read, write, read_write };

// One storage buffer of a kernel, as declared by BUFFER_IN, BUFFER_OUT or BUFFER_INOUT.
struct Binding {
    const char* name;
    Access access;
    std::uint32_t element_bytes;
};

// What the native form of a kernel gets: the base address of each binding, and the parameters.
struct NativeArgs {
    void* const* buffers;
    const void* params;
};

// Runs the work-groups [first, last). A group's lanes run in order on the calling thread.
using NativeEntry = void (*)(const NativeArgs& args, std::uint32_t first, std::uint32_t last);

// One native build of a kernel per instruction set; the device picks the best that the CPU has.
struct NativeEntries {
    NativeEntry baseline;  // x86-64, or whatever the compiler's default target is
    NativeEntry avx2;      // x86-64-v3, or null
    NativeEntry avx512;    // x86-64-v4, or null
};

// A kernel in the three forms that kernels/tools/build_kernels.py makes of its one source. Devices
// cache what they build of it under its address, so it must outlive them.
struct KernelSource {
    const char* name;
    std::uint32_t group_size;  // work-items in a group
    // Elements that one work-item handles, per backend; and on a real GPU, by OpenCL or Vulkan.
    std::uint32_t items_native, items_opencl, items_vulkan, items_gpu;
    bool per_group;  // the work is counted in groups (BEGIN_GROUP), not in elements
    std::uint32_t params_bytes;
    std::span<const Binding> bindings;
    std::span<const std::uint32_t> spirv;
    const char* opencl;  // OpenCL C 1.2 text
    NativeEntries native;
    // The form that checks indices (TOPPLE_CHECK=bounds), which binds one buffer more; or null.
    const KernelSource* checked = nullptr;
};

}  // namespace topple::device
