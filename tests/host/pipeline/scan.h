// SPDX-License-Identifier: MIT
#pragma once

#include "core/vectors.h"
#include "host/io/files.h"
#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "lab/scores/score.h"
#include "topple/device.h"
#include "topple/parse.h"
#include "vdb/voxel_scene.h"

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

// What a parse says of a place, metres.
inline vdb::State state_at(const ParseResult& result, const Vec3& place) {
    const vdb::VoxelFrame frame = result.voxels->frame();
    const Vec3 in_grid = frame.grid_of(place);
    std::array<std::int32_t, 3> at{};
    for (std::size_t a = 0; a < 3; ++a)
        at[a] = static_cast<std::int32_t>(std::floor(in_grid[a] / frame.voxel_m));
    return result.voxels->state_at(at[0], at[1], at[2]);
}

inline bool noted(const Scene& scene, const std::string& text) {
    return std::ranges::any_of(
        scene.notes, [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

// The object that can move whose centre of mass lies there; null: none does.
inline const Object* movable_at(const Scene& scene, const Vec3& center, double within_m) {
    for (const Object& o : scene.objects)
        if (!o.grounded && length(minus(o.center_of_mass_m, center)) < within_m) return &o;
    return nullptr;
}

// The default options, on this device.
inline ParseOptions on(std::shared_ptr<device::Device> device) {
    ParseOptions options;
    options.device = std::move(device);
    return options;
}

}  // namespace topple::test
