// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "topple/input.h"

namespace topple {

// Depth frames that can be walked through more than once without holding them all.
class FrameStream {
  public:
    virtual ~FrameStream() = default;
    virtual const Intrinsics& intrinsics() const = 0;
    virtual std::size_t size() const = 0;
    virtual DepthFrame load(std::size_t i) const = 0;
    // With its colours, where it has any.
    virtual DepthFrame load_coloured(std::size_t i) const { return load(i); }
    // Whether frames may be loaded on the thread that called the parse alone, one after the other.
    virtual bool one_by_one() const { return false; }
};

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
