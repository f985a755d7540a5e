// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/thread_pool.h"
#include "topple/input.h"

namespace topple::live {

// A pixel, the depth that it holds, and how many looks saw through its place.
struct GonePixel {
    std::uint32_t u, v;
    std::uint16_t stored;
    std::uint8_t through;
};
using Gone = std::vector<GonePixel>;

// Which others are asked about a frame: [first, last) of those given, the last ones first.
using Asked = std::function<std::pair<std::size_t, std::size_t>(std::size_t frame)>;

// Depth frames that are asked about one another; all must stay.
class Looks {
  public:
    Looks(const Intrinsics& intrinsics, std::span<const DepthFrame> frames, ThreadPool& threads);
    // Of each frame the pixels that show places which those asked see through: of later ones, what
    // was there has gone since; of earlier ones, it has come. It takes most of the first three
    // looks. The result depends on the frames and their poses alone.
    std::vector<Gone> seen_through(const Asked& asked) const;

  private:
    Intrinsics intrinsics_;
    std::span<const DepthFrame> frames_;
    ThreadPool& threads_;
    // Of each frame, by pixel: the nearest reading of the nine around; 0 where one is missing.
    std::vector<std::vector<std::uint16_t>> nearest_;
};

}  // namespace topple::live
