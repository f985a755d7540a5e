// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "points/frames_fusion.h"
#include "points/scale_checks.h"
#include "topple/parse.h"

namespace topple {

// A fusion that takes no more memory than ParseOptions::max_memory_bytes, and says of frames that
// need more what to do about it.
class LimitedFusion {
  public:
    struct Frames {
        const Intrinsics& intrinsics;
        std::size_t count = 0;
        double typical_depth_m = 0;
        const std::string& source;
        ScanOrigin origin;
    };
    // What is referred to must stay. Throws Error(input), as the others do.
    LimitedFusion(const Frames& frames, double cell_m, const ParseOptions& options,
                  unsigned threads);
    void add(const DepthFrame& frame);
    geometry::FusedCloud finish(const std::function<void()>& poll);

  private:
    void check() const;
    Frames frames_;
    const ParseOptions& options_;
    geometry::FrameFusion fusion_;
    std::size_t most_bytes_ = SIZE_MAX, added_ = 0;
};

}  // namespace topple
