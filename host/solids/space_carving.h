// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "device/stage_clock.h"
#include "geometry/surface_gaps.h"
#include "points/observation.h"
#include "topple/kernels/device.h"
#include "vdb/voxel_scene.h"

// Visibility carving (paper, 2.2.2): what depth frames say about the voxels.
namespace topple {

// The surface voxels of a scan, and of the others those that its frames saw through. Where nothing
// that is found out later has a say in which voxels hold points, they are carved beside the stages
// in between, on a thread of its own. Until finish() nobody else may use the device, but for its
// threads.
class SpaceCarving {
  public:
    // The input must stay as long as this.
    SpaceCarving(device::Device& device, const Observation& input, const vdb::VoxelFrame& frame);
    // Ends what goes on beside.
    ~SpaceCarving();
    SpaceCarving(const SpaceCarving&) = delete;
    SpaceCarving& operator=(const SpaceCarving&) = delete;

    const vdb::VoxelFrame& frame() const { return frame_; }

    // Whether gaps between points are to be closed, which hold points then: larger voxels close
    // them by themselves.
    bool closes_gaps() const;

    struct Carved {
        std::shared_ptr<vdb::VoxelScene> scene;
        bool from_around = false;  // whether the frames show the scene from around
    };
    // What VoxelScene is told of the points and, after them, of those that close gaps.
    struct Marks {
        std::vector<std::int32_t> label;
        std::vector<std::uint8_t> seen_side;
    };
    // Once. Throws what carving beside has thrown.
    Carved finish(const Marks& marks, const geometry::GapPoints& gaps, StageClock& stage);

  private:
    void begin();
    bool carve(vdb::VoxelScene& scene, const std::function<void(double)>& progress) const;
    Carved take_carved(const Marks& marks);

    device::Device& device_;
    const Observation& input_;
    vdb::VoxelFrame frame_;
    std::stop_source stop_;
    std::future<Carved> beside_;  // not valid: nothing goes on beside
};

}  // namespace topple
