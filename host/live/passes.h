// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "live/frame_store.h"
#include "live/known_things.h"
#include "live/scan_kind.h"
#include "live/seen_through.h"
#include "topple/frame_labels.h"

namespace topple::live {

// The frames of a session as they tell of one another: what later ones say of each, and of those
// after the ones of the last update what earlier ones say.
class Passes {
  public:
    // frames, kind: must stay. parsed: the poses of the last update.
    Passes(const Frames& frames, const ScanKind& kind, const std::map<FrameId, Mat4>& parsed,
           ThreadPool& threads);

    // Of each frame what is left out of it. remembered: what went before, to which is added what
    // has gone since. no_longer: by thing of the last update, whether it is no longer there.
    std::vector<Gone> leave_out(Remembered& remembered, std::vector<bool>& no_longer) const;
    // What some of the frames show.
    ShownObjects shown(const FrameLabeller& labeller) const;

  private:
    const Frames& frames_;
    const ScanKind& kind_;
    ThreadPool& threads_;
    std::vector<FrameId> ids_;
    std::vector<DepthFrame> images_;
    std::vector<Looked> later_, earlier_;
};

}  // namespace topple::live
