// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "live/seen_through.h"
#include "topple/input.h"

namespace topple::live {

// Each step-th pixel of a depth image, and of its rows: 160 in a row or somewhat more, enough to
// tell things by.
class Coarse {
  public:
    explicit Coarse(const Intrinsics& intrinsics);
    const Intrinsics& intrinsics() const { return coarse_; }
    DepthFrame of(const DepthFrame& frame) const;  // without colours
    // Clears the readings around pixels of the coarse image that are of about the same depth.
    // Whether there were any.
    bool leave_out(const Gone& gone, DepthFrame& frame) const;

  private:
    Intrinsics fine_, coarse_;
    std::uint32_t step_;
};

}  // namespace topple::live
