// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "points/frame_stream.h"
#include "points/observation.h"

// Where a parse reckons coordinates from: a place that belongs to the scan. Cells and voxels lie by
// it, so that a scan that is moved as a whole is parsed the same, and two scans of a room nearly
// so.
namespace topple {

// Where the cloud's densest planes across its axes are, metres: of most rooms the floor and two
// walls. The place of the mode, from points counted by the centimetre, then the mean around it.
// Moves with the cloud, whatever the order of its points.
Vec3 densest_planes(const CloudView& cloud);
// The same of frames: from some readings of some of them.
Vec3 densest_planes(const FrameStream& frames, ThreadPool& threads);

// Reckons the cloud's coordinates and its sensors' from `origin`, in the input's frame, instead of
// from where they were reckoned from before. Frames and what else comes of the cloud must not be
// there yet.
void reckon_from(const Vec3& origin, Observation& input);

// So that planes at `planes` lie amid voxels, and noise doesn't spread them over two layers.
Vec3 origin_amid_voxels(const Vec3& planes, double voxel_m);

// Depth frames with their poses reckoned from `origin`.
class ReckonedFrames final : public FrameStream {
  public:
    ReckonedFrames(std::unique_ptr<FrameStream> frames, const Vec3& origin)
        : frames_(std::move(frames)), origin_(origin) {}
    const Intrinsics& intrinsics() const override { return frames_->intrinsics(); }
    std::size_t size() const override { return frames_->size(); }
    DepthFrame load(std::size_t i) const override { return reckoned(frames_->load(i)); }
    DepthFrame load_coloured(std::size_t i) const override {
        return reckoned(frames_->load_coloured(i));
    }
    bool one_by_one() const override { return frames_->one_by_one(); }

  private:
    DepthFrame reckoned(DepthFrame frame) const {
        for (std::size_t a = 0; a < 3; ++a) frame.camera_to_world[4 * a + 3] -= origin_[a];
        return frame;
    }
    std::unique_ptr<FrameStream> frames_;
    Vec3 origin_;
};

}  // namespace topple
