// SPDX-License-Identifier: MIT
#pragma once

#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "topple/frames_view.h"

namespace topple::test {

// Six small depth frames of a walk through a furnished room.
inline scenes::Sequence small_walk() {
    scenes::RoomOptions room;
    room.seed = 3;
    scenes::CameraOptions camera;
    camera.intrinsics = {96, 72, 83, 83, 47.5, 35.5, 1000};
    camera.frames = 6;
    return scenes::walk(scenes::furnished_room(room), camera);
}

// They and their poses, not copied.
inline FramesView frames_view_of(const scenes::Sequence& walk) {
    FramesView out;
    out.intrinsics = walk.intrinsics;
    for (const DepthFrame& frame : walk.frames) {
        out.camera_to_world.push_back(frame.camera_to_world);
        out.images.emplace_back().depth = {frame.depth.data(), walk.intrinsics.width,
                                           walk.intrinsics.height};
    }
    return out;
}

}  // namespace topple::test
