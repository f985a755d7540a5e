// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "topple/error.h"
#include "topple/kernels/device.h"

namespace topple::device {

// A range of a Buffer's elements, to bind to a kernel.
template <class T>
struct Slice {
    BoundRange range;
};

// A named, sized array of T on a device. Move-only. T must be one of the kernel dialect's buffer
// types: float, std::int32_t, std::uint32_t.
template <class T>
class Buffer {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) == 4);

  public:
    Buffer() = default;
    Buffer(Device& device, std::uint64_t count, const std::string& name)
        : device_(&device), count_(count) {
        if (count > std::numeric_limits<std::uint64_t>::max() / sizeof(T)) {
            throw Error(ErrorKind::device, "buffer " + name + ": " + std::to_string(count) +
                                               " elements overflow a 64-bit size");
        }
        memory_ = device.allocate(count * sizeof(T), name);
    }
    // Allocates and uploads.
    Buffer(Device& device, std::span<const T> data, const std::string& name)
        : Buffer(device, data.size(), name) {
        upload(data);
    }
    Buffer(Buffer&&) noexcept = default;
    Buffer& operator=(Buffer&&) noexcept = default;

    std::uint64_t size() const { return count_; }
    const std::string& name() const { return memory_->name(); }
    Device& device() const { return *device_; }

    void upload(std::span<const T> data, std::uint64_t first = 0) {
        check(first, data.size());
        if (!data.empty()) device_->write(*memory_, first * sizeof(T), std::as_bytes(data));
    }
    void download(std::span<T> to, std::uint64_t first = 0) const {
        check(first, to.size());
        if (!to.empty()) device_->read(*memory_, first * sizeof(T), std::as_writable_bytes(to));
    }
    std::vector<T> download() const {
        std::vector<T> out(count_);
        download(std::span<T>(out));
        return out;
    }
    // Sets every element to the value.
    void fill(T value) {
        std::uint32_t word;
        static_assert(sizeof(word) == sizeof(T));
        __builtin_memcpy(&word, &value, sizeof(word));
        if (count_) device_->fill(*memory_, 0, count_ * sizeof(T), word);
    }

    // Elements [first, first + count). first * 4 must be a multiple of slice_alignment.
    Slice<T> slice(std::uint64_t first, std::uint64_t count) const {
        check(first, count);
        if (first * sizeof(T) % slice_alignment != 0) {
            throw Error(ErrorKind::device, "buffer " + name() +
                                               ": a slice must start at a multiple of " +
                                               std::to_string(slice_alignment / sizeof(T)) +
                                               " elements, not at " + std::to_string(first));
        }
        return {{memory_.get(), first * sizeof(T), count * sizeof(T)}};
    }
    operator Slice<T>() const { return slice(0, count_); }

    // The elements themselves where the device shares the host's memory, else empty. Not to be
    // touched while a batch in flight binds them.
    std::span<T> host_view() const {
        auto* address = memory_ ? device_->host_view(*memory_) : nullptr;
        return address ? std::span<T>(reinterpret_cast<T*>(address), count_) : std::span<T>();
    }

  private:
    void check(std::uint64_t first, std::uint64_t count) const {
        if (first > count_ || count > count_ - first) {
            throw Error(ErrorKind::device,
                        "buffer " + name() + ": range [" + std::to_string(first) + ", " +
                            std::to_string(first + count) + ") is outside of its " +
                            std::to_string(count_) + " elements");
        }
    }

    Device* device_ = nullptr;
    std::uint64_t count_ = 0;
    MemoryPtr memory_;
};

// The types of a kernel's arguments. Each takes a Buffer or a Slice of the right element type.
template <class T>
struct Argument {
    BoundRange range;
    Argument(const Slice<T>& slice) : range(slice.range) {}
    Argument(const Buffer<T>& buffer) : range(static_cast<Slice<T>>(buffer).range) {}
};

// A sparse grid (primitives/sparse_grid.h), which a kernel takes by GRID_IN.
struct GridArgument {
    Argument<std::uint32_t> leaf_low, leaf_high, first, mask;
};

}  // namespace topple::device
