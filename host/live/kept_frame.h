// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "topple/input.h"

namespace topple::live {

// Bytes without their redundancy, which must be so many again.
class Packed {
  public:
    Packed() = default;
    explicit Packed(const std::vector<std::uint8_t>& bytes);
    std::vector<std::uint8_t> unpacked() const;
    std::size_t bytes() const { return packed_.capacity(); }
    std::uint64_t unpacked_bytes() const { return unpacked_bytes_; }
    // For both ways (core/fields.h).
    template <class Io, class Self>
    static void fields(Io& io, Self& packed) {
        io(packed.unpacked_bytes_);
        io(packed.packed_);
    }

  private:
    std::vector<std::uint8_t> packed_;
    std::uint64_t unpacked_bytes_ = 0;
};

// A depth frame in a third of its memory, but for its pose.
class KeptFrame {
  public:
    KeptFrame() = default;
    KeptFrame(const DepthFrame& frame, std::uint32_t width);
    // With the identity for a pose; without its colours, or with them.
    DepthFrame depth_frame() const;
    DepthFrame frame() const;
    std::size_t bytes() const { return depth_.bytes() + colour_.bytes(); }
    // Whether it is an image of that size, with colours or without.
    bool is_of(std::uint32_t width, std::uint32_t height) const {
        const std::uint64_t pixels = std::uint64_t{width} * height;
        return width_ == width && depth_.unpacked_bytes() == 2 * pixels &&
               (colour_.unpacked_bytes() == 0 || colour_.unpacked_bytes() == 3 * pixels);
    }
    template <class Io, class Self>
    static void fields(Io& io, Self& frame) {
        io(frame.width_);
        Packed::fields(io, frame.depth_);
        Packed::fields(io, frame.colour_);
    }

  private:
    std::uint32_t width_ = 0;
    Packed depth_, colour_;
};

}  // namespace topple::live
