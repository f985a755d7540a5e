// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "points/frame_stream.h"

namespace topple {

// Depth frames that are held.
class MemoryStream final : public FrameStream {
  public:
    MemoryStream(const Intrinsics& intrinsics, std::vector<DepthFrame> frames)
        : intrinsics_(intrinsics), frames_(std::move(frames)) {}
    const Intrinsics& intrinsics() const override { return intrinsics_; }
    std::size_t size() const override { return frames_.size(); }
    DepthFrame load(std::size_t i) const override { return frames_[i]; }

  private:
    Intrinsics intrinsics_;
    std::vector<DepthFrame> frames_;
};

}  // namespace topple
