// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "live/frame_store.h"
#include "live/scan_kind.h"
#include "topple/session.h"

namespace topple::live {

// Looks what came since a scene was parsed, from any thread, one at a time.
class Glance {
  public:
    // kind: must stay.
    Glance(const ScanKind& kind, unsigned threads) : kind_(kind), threads_(threads) {}
    // In the latest of the frames that the scene was not parsed from. labeller: of the scene.
    std::vector<Appeared> operator()(const LiveScene& scene, const FrameLabeller& labeller,
                                     const Frames& frames, const ParseOptions& options) const;

  private:
    std::vector<bool> came_in(const PosedFrame& frame, const Frames& frames,
                              const std::vector<FrameId>& parsed) const;

    const ScanKind& kind_;
    unsigned threads_;
    mutable std::mutex mutex_;
    // An update may be at work with the session's; results are the same on any.
    mutable std::shared_ptr<device::Device> device_;
};

}  // namespace topple::live
