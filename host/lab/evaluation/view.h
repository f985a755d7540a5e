// SPDX-License-Identifier: MIT
#pragma once

#include "lab/evaluation/room.h"
#include "lab/scan/depth_camera.h"
#include "lab/scores/volume_score.h"
#include "topple/scene.h"

// What a camera could have seen of a room, and what it did not.
namespace topple::evaluation {

// The places inside of the room, between its floor, walls and height, that project into an image of
// the sequence within the camera's range, hidden or not. Keeps references to its arguments.
scenes::Domain in_view(const scenes::World& world, const scenes::CameraOptions& camera,
                       const scenes::Sequence& sequence);

// All voxels within the scan's bounds and the domain that were not seen to be empty, in the world's
// input frame. Every voxel has state 0 and no primitive.
SolidVoxels never_seen_empty(const Room& room, const scenes::Domain& domain);

// The voxels whose state is 0.
SolidVoxels surface_alone(const SolidVoxels& solid);

}  // namespace topple::evaluation
