// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "lab/solids/scene.h"
#include "topple/input.h"

// A depth camera that walks through a World.
namespace topple::scenes {

struct CameraOptions {
    Intrinsics intrinsics{320, 240, 277, 277, 159.5, 119.5, 1000};
    std::uint64_t seed = 1;
    unsigned frames = 60;
    bool single = false;  // one frame of the best furnished side instead of a walk
    bool noise = true;    // all of what follows; without it, depths are exact to rounding
    double min_range_m = 0.4, max_range_m = 5.5;
    // Standard deviation of depth: axial_m + growth * (z - 0.4)^2 (Nguyen, Izadi & Lovell 2012, for
    // a Kinect), more at grazing incidence.
    double axial_m = 0.0012, growth = 0.0019;
    double lateral_px = 0.25;  // standard deviation of where in the image a pixel looks
    double grazing_deg = 82;   // flatter than this: no reading
    double fuse_m = 0.01;      // cell of the fused cloud
    unsigned threads = 0;      // 0: all cores; the result does not depend on it
};

struct Sequence {
    Intrinsics intrinsics;
    std::vector<DepthFrame> frames;               // poses in the input's frame
    std::vector<std::vector<std::int16_t>> part;  // of each pixel, -1 for none
    PointCloud cloud;                             // fused, input frame; a single frame's own points
    std::vector<std::int32_t> part_of_point;      // majority of each cell
};

// Camera to room for an eye looking at a target: columns right, down, forward, eye. Row-major.
Mat4 look_at(const Vec3& eye, const Vec3& target);

// One depth image from a pose in the room's frame. `frame_number` picks the noise. Returns the part
// that each pixel shows.
std::vector<std::int16_t> render(const World& world, const CameraOptions& options,
                                 const Mat4& camera_to_room, std::uint64_t frame_number,
                                 std::vector<std::uint16_t>& depth);

// Renders and fuses frames from these poses, camera to room.
Sequence film(const World& world, const CameraOptions& options, std::span<const Mat4> poses);

// Renders and fuses a walk around the room's free middle, at eye height, looking both out and
// across.
Sequence walk(const World& world, const CameraOptions& options);

// Fills the sequence's cloud from its frames: the mean of the readings in each cell of fuse_m; a
// cell with one reading only is taken for a stray. Points are ordered by cell (x, then y, then z).
// A single frame's points are kept as they are, in the order of the pixels.
void fuse(const CameraOptions& options, Sequence& sequence);

// FOLDER/depth/NNNN.png (16 bit), intrinsics.json, trajectory.txt (not for a single frame; TUM:
// time x y z qx qy qz qw, camera to world), cloud.ply, truth.json. Throws Error(input) where it
// can't write.
void write_sequence(const std::filesystem::path& folder, const World& world,
                    const Sequence& sequence);

// A binary .ply of x y z.
void write_cloud(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace topple::scenes
