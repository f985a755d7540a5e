// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/json.h"
#include "points/formats/colour_frames.h"
#include "points/frame_stream.h"
#include "topple/input.h"

namespace topple::io {

// A folder of depth images:
//   depth/*.png       16-bit grey, metres = value / depth_scale, 0 = no reading; in order of name
//   intrinsics.json   {"width", "height", "fx", "fy", "cx", "cy", "depth_scale"}
//   color/*.png, *.jpg  what the camera saw, where there are any: see ColourFrames
//   trajectory.txt    a pose per image, camera to world, metres; camera x right, y down, z forward:
//                     see read_trajectory(). Or trajectory.log, or poses.txt; one of them.
// Without any it must hold one image; its camera is then the world's origin.
class FrameSequence final : public FrameStream {
  public:
    // Reads all but the images. Throws Error(input) naming the file that is missing or wrong.
    static FrameSequence open(const std::filesystem::path& folder);

    const Intrinsics& intrinsics() const override { return intrinsics_; }
    std::size_t size() const override { return images_.size(); }
    bool posed() const { return posed_; }  // there is a file of poses
    const std::vector<Mat4>& poses() const { return poses_; }

    // Reads image `index` < size(). May be called from several threads at once. Throws Error(input)
    // naming the image where it is damaged, no 16-bit grey PNG, or of another size than
    // intrinsics().
    DepthFrame load(std::size_t index) const override;
    DepthFrame load_coloured(std::size_t index) const override;
    // What load_coloured() reads: the depth image, and the colour image where there is one.
    std::vector<std::filesystem::path> files(std::size_t index) const;
    // The colour images of the same frames.
    const ColourFrames& colours() const { return colours_; }

    // Of all poses; without a trajectory it is the one camera's. See points/formats/rigid_pose.h.
    std::optional<Vec3> mean_camera_up() const;

  private:
    Intrinsics intrinsics_;
    std::vector<FileName> images_;
    std::vector<Mat4> poses_;
    ColourFrames colours_;
    bool posed_ = false;
};

// Whether the path is a folder with depth/ or intrinsics.json in it. open() says what is missing.
bool looks_like_sequence(const std::filesystem::path& path);

// What is wrong with the intrinsics of a depth camera, if anything; of any pinhole camera.
std::optional<std::string> depth_intrinsics_fault(const Intrinsics& intrinsics);
std::optional<std::string> pinhole_fault(const Intrinsics& intrinsics);

// Those of a depth camera in an object of JSON. Throws Error(input) that names `file`.
Intrinsics depth_intrinsics(const std::filesystem::path& file, const Json& json);

// The parts of open() and load(), for tests.
Intrinsics read_intrinsics(const FileName& file);
std::vector<std::uint16_t> read_depth_png(const FileName& file, std::uint32_t width,
                                          std::uint32_t height);

// Poses, camera to world, the first of the first image in order of name. Whatever the file's name,
// its first line tells what it is; # starts comments:
//   8 numbers   TUM: `t x y z qx qy qz qw`; line n is the n-th image's
//   12 numbers  KITTI: three rows of a matrix, [R | t], in one line; line n is the n-th image's
//   3 numbers   Open3D: a line of three whole numbers, of which the first is the number of the
//               image, from 0, then four lines of a 4x4 matrix. Any order; each image once.
// Matrices must be rotations to 1e-3, and are made so exactly. Throws Error(input) naming the line.
std::vector<Mat4> read_trajectory(const FileName& file);

}  // namespace topple::io
