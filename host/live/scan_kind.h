// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "live/frame_store.h"
#include "live/known_things.h"
#include "live/projection.h"
#include "live/seen_through.h"
#include "topple/frame_labels.h"
#include "topple/parse.h"
#include "topple/session.h"

namespace topple::live {

// What the frames of a session are, and what becomes of them.
class ScanKind {
  public:
    virtual ~ScanKind() = default;
    // Of images that are coarse, but enough to tell things by.
    virtual const Projection& projection() const = 0;
    // Of a frame, by that, without its pose.
    virtual DepthFrame image(const KeptFrame& frame) const = 0;
    // What parse() finds in them, called `source`. gone: of each frame what is left out of it where
    // that is sure; empty: nothing. left_out: whether anything was.
    virtual ParseResult parse(const Frames& frames, std::span<const Gone> gone,
                              const std::string& source, const ParseOptions& options,
                              bool& left_out) const = 0;
    // Its readings, or enough of them, in the sensor's axes.
    virtual PointCloud points(const PosedFrame& frame) const = 0;
    // Some places of a frame, the same ones whatever its pose is: pixels of its image, and the
    // objects that a result has there, -1: none.
    struct Spots {
        std::vector<std::uint32_t> pixel;
        std::vector<std::int32_t> object;
    };
    // Those pixels alone.
    virtual std::vector<std::uint32_t> spot_pixels(const PosedFrame& frame) const = 0;
    virtual Spots spots(const PosedFrame& frame, const DepthFrame& image,
                        const FrameLabeller& labeller, unsigned threads) const = 0;
};

// Of depth frames of such a camera.
std::unique_ptr<ScanKind> depth_frames(const Intrinsics& depth);
// Of sweeps of points.
std::unique_ptr<ScanKind> point_sweeps();
std::unique_ptr<ScanKind> scan_kind(const Checkpoint& of);

}  // namespace topple::live
