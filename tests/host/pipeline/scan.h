// SPDX-License-Identifier: MIT
#pragma once

#include "host/io/files.h"
#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "lab/scores/score.h"
#include "topple/device.h"
#include "topple/parse.h"

// Small scans of a furnished room whose truth is known.
namespace topple::test {

struct Scan {
    scenes::World world;
    scenes::Sequence sequence;
};

inline Scan scan_of_room(std::uint64_t seed, unsigned frames, double tilt_deg = 0) {
    scenes::RoomOptions room;
    room.seed = seed;
    room.tilt_deg = tilt_deg;
    scenes::CameraOptions camera;
    camera.seed = seed;
    camera.frames = frames;
    camera.single = frames == 1;
    Scan scan{scenes::furnished_room(room), {}};
    scan.sequence = scenes::walk(scan.world, camera);
    return scan;
}

// A sparse cloud of a room: for what is about the cloud, not about how well it is understood.
inline PointCloud cloud_of_room(std::uint64_t seed) {
    Scan scan = scan_of_room(seed, 8);
    scenes::CameraOptions camera;
    camera.fuse_m = 0.025;
    scenes::fuse(camera, scan.sequence);
    return scan.sequence.cloud;
}

// The default options, on this device.
inline ParseOptions on(std::shared_ptr<device::Device> device) {
    ParseOptions options;
    options.device = std::move(device);
    return options;
}

}  // namespace topple::test
