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

  private:
    std::vector<std::uint8_t> packed_;
    std::size_t unpacked_bytes_ = 0;
};

// A depth frame in a third of its memory, but for its pose.
class KeptFrame {
  public:
    KeptFrame(const DepthFrame& frame, std::uint32_t width);
    // With the identity for a pose; without its colours, or with them.
    DepthFrame depth_frame() const;
    DepthFrame frame() const;
    std::size_t bytes() const { return depth_.bytes() + colour_.bytes(); }

  private:
    std::uint32_t width_;
    Packed depth_, colour_;
};

}  // namespace topple::live
