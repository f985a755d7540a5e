// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "topple/cloud_view.h"

namespace topple::geometry {

// A cloud with the sensor position of each point.
struct FusedCloud {
    PointCloud cloud;
    std::vector<Vec3> viewpoints;                   // one per frame that was fused
    std::vector<std::uint32_t> viewpoint_of_point;  // index into viewpoints
};

// Fuses depth frames into one cloud: back-projects, then takes the mean of the readings in each
// cell of `cell_m`, weighted by the inverse variance of a depth reading (which grows with depth),
// the mean of their colours in the same way, and drops cells that a single stray reading made where
// others had the chance to see them, and those that most frames deny. Frames are added one at a
// time, so a sequence of any length needs memory for the cloud and Witnesses::most_frames of them
// only. Of no more frames than that the result does not depend on their order beyond rounding.
class FrameFusion {
  public:
    // threads: 0 for one per core. The result does not depend on it.
    FrameFusion(const Intrinsics& intrinsics, double cell_m, unsigned threads = 0);
    ~FrameFusion();
    FrameFusion(FrameFusion&&) noexcept;
    void add(const DepthFrame& frame);
    // That it holds, and that finish() takes besides, but for readings that wait: up to 100 MB.
    std::size_t bytes() const;
    // Once it would hold more than this, bytes() does say more, and what is added gets lost.
    void set_most_bytes(std::size_t most_bytes);
    // Takes up what waits. finish() does so, too.
    void flush();
    // poll: called now and then; what it throws ends the fusion.
    FusedCloud finish(const std::function<void()>& poll = [] {});

  private:
    struct Cells;
    std::unique_ptr<Cells> cells_;
    Intrinsics intrinsics_;
    double cell_m_;
};

// The depth frame that an organised cloud was made from, with the intrinsics recovered by least
// squares from its points; depth_scale is chosen to keep sub-millimetre depth where it fits.
// The camera looks along z with y down or, where the points say so, along -z with y up: its upward
// axis is the frame's -y axis (camera_to_world), the hint for find_scene_frame. Returns false where
// the points are no pinhole image (residual above one pixel).
bool frame_of_organised_cloud(const CloudView& cloud, Intrinsics& intrinsics, DepthFrame& frame);

}  // namespace topple::geometry
