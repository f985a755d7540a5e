// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <type_traits>

#include "device/adopted_buffer.h"
#include "topple/kernels/buffer.h"
#include "topple/stages.h"

namespace topple::stages {

// A stage's array as kernels bind it: uploaded, or the caller's buffer.
template <class T>
class Bound {
    using Element = std::remove_const_t<T>;

  public:
    // An array in host memory is taken to be `count` elements long on the device, and only
    // uploaded where it is read.
    Bound(device::Device& device, const Array<T>& array, std::uint64_t count,
          const std::string& name) {
        if (!array.on_device()) {
            own_ = device::Buffer<Element>(device, count, name);
            if constexpr (std::is_const_v<T>) own_.upload(array.host);
            slice_ = own_;
            return;
        }
        const DeviceBuffer& b = array.buffer;
        if (b.offset_bytes % device::slice_alignment != 0 || b.offset_bytes > b.bytes ||
            array.count > (b.bytes - b.offset_bytes) / sizeof(T)) {
            throw Error(ErrorKind::usage, "buffer " + name + ": " + std::to_string(array.count) +
                                              " elements from byte " +
                                              std::to_string(b.offset_bytes) +
                                              " are not within its " + std::to_string(b.bytes) +
                                              " bytes, or do not start at a multiple of " +
                                              std::to_string(device::slice_alignment));
        }
        adopted_ = device::adopt_buffer(device, b.handle, b.bytes, name);
        slice_ = {{adopted_.get(), b.offset_bytes, array.count * sizeof(T)}};
    }
    Bound(const Bound&) = delete;
    Bound& operator=(const Bound&) = delete;

    device::Slice<Element> slice() const { return slice_; }
    // What was not the caller's buffer.
    const device::Buffer<Element>& own() const { return own_; }

  private:
    device::Buffer<Element> own_;
    device::MemoryPtr adopted_;
    device::Slice<Element> slice_;
};

// Throws Error(usage) "<stage>: <what>" unless it holds.
inline void require(bool holds, const char* stage, const std::string& what) {
    if (!holds) throw Error(ErrorKind::usage, std::string(stage) + ": " + what);
}

}  // namespace topple::stages
