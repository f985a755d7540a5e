// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "lab/scores/score.h"
#include "lab/solids/rigid.h"
#include "topple/parse.h"

// One generated room: scanned, parsed, judged.
namespace topple::evaluation {

struct RoomOptions {
    scenes::RoomOptions room;
    scenes::CameraOptions camera;
    ParseOptions parse;
};

struct Room {
    scenes::World world;
    scenes::CameraOptions camera;
    scenes::Sequence sequence;
    // The places of the scene's points and solid voxels, and its up, are in the world's input
    // frame. The voxel grid is in the frame of what was parsed: the camera's, where that was a
    // single frame.
    ParseResult parse;
    Mat4 input_from_grid = scenes::identity;
    std::vector<std::int32_t> part;  // the true part of each point, -1 for none
};

// Throws what generating and parsing throw.
Room scan_and_parse(const RoomOptions& options);

// The places inside of the room, between its floor, walls and height, that project into an image of
// the sequence within the camera's range, hidden or not. Keeps references to its arguments.
scenes::Domain in_view(const scenes::World& world, const scenes::CameraOptions& camera,
                       const scenes::Sequence& sequence);

// All voxels within the scan's bounds and the domain that were not seen to be empty, in the world's
// input frame. Places alone.
SolidVoxels never_seen_empty(const Room& room, const scenes::Domain& domain);

// The places of the voxels whose state is 0.
SolidVoxels surface_alone(const SolidVoxels& solid);

// The measures of the paper's Section 6.
struct RoomScore {
    std::uint64_t seed = 0;
    std::size_t points = 0, parts = 0, objects = 0;  // the last two: true ones
    // 6.1, Fig. 14. Regions are what growing alone finds, before any merging.
    scenes::SegmentationScore parts_by_region, parts_by_primitive;
    scenes::SegmentationScore objects_by_region, objects_by_primitive, objects_by_object;
    // 6.2, Table 2, in the part of the room that lay in some frame's view: surface voxels alone,
    // all voxels that no ray was seen to pass through, and surface with completed voxels.
    scenes::VolumeScore surface, invisible, completed;
    scenes::RelationScore relations;  // 6.3, Table 3
    double gravity_deg = 0;
    double parse_s = 0;
};

RoomScore judge(const Room& room);

}  // namespace topple::evaluation
