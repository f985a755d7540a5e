// SPDX-License-Identifier: MIT
#pragma once

#include <array>
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
    // Whether so many bytes can have been made so few.
    bool is_plausible() const {
        constexpr std::uint64_t most_ratio = 1040;  // deflate's is 1032
        return unpacked_bytes_ / most_ratio <= packed_.size();
    }
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

// A depth frame in a third of its memory, but for its pose; or points of a sensor, in its axes.
class KeptFrame {
  public:
    KeptFrame() = default;
    KeptFrame(const DepthFrame& frame, std::uint32_t width);
    explicit KeptFrame(const PointCloud& points);  // their places and colours
    // With the identity for a pose; without its colours, or with them.
    DepthFrame depth_frame() const;
    DepthFrame frame() const;
    PointCloud points() const;
    bool is_coloured() const { return colour_.unpacked_bytes() > 0; }
    std::size_t bytes() const { return depth_.bytes() + places_.bytes() + colour_.bytes(); }
    // Whether it is an image of that size, with colours or without.
    bool is_of(std::uint32_t width, std::uint32_t height) const {
        const std::uint64_t pixels = std::uint64_t{width} * height;
        return width_ == width && depth_.unpacked_bytes() == 2 * pixels &&
               (colour_.unpacked_bytes() == 0 || colour_.unpacked_bytes() == 3 * pixels);
    }
    // Whether it is points instead, one or more, with colours or without.
    bool is_of_points() const {
        const std::uint64_t points = places_.unpacked_bytes() / sizeof(Place);
        return depth_.unpacked_bytes() == 0 && points > 0 && places_.is_plausible() &&
               places_.unpacked_bytes() % sizeof(Place) == 0 &&
               (colour_.unpacked_bytes() == 0 || colour_.unpacked_bytes() == 3 * points);
    }
    template <class Io, class Self>
    static void fields(Io& io, Self& frame) {
        io(frame.width_);
        Packed::fields(io, frame.depth_);
        Packed::fields(io, frame.places_);
        Packed::fields(io, frame.colour_);
    }

  private:
    using Place = std::array<float, 3>;
    std::uint32_t width_ = 0;
    Packed depth_, places_, colour_;
};

}  // namespace topple::live
