// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "topple/input.h"

namespace topple::io {

// A folder of depth images:
//   depth/*.png       16-bit grey, metres = value / depth_scale, 0 = no reading; in order of name
//   intrinsics.json   {"width", "height", "fx", "fy", "cx", "cy", "depth_scale"}
//   trajectory.txt    one line `t x y z qx qy qz qw` per image (TUM): camera to world, metres;
//                     camera x right, y down, z forward. # starts comments.
// Without trajectory.txt it must hold one image; its camera is then the world's origin.
class FrameSequence {
  public:
    // Reads all but the images. Throws Error(input) naming the file that is missing or wrong.
    static FrameSequence open(const std::filesystem::path& folder);

    const Intrinsics& intrinsics() const { return intrinsics_; }
    std::size_t size() const { return images_.size(); }
    bool posed() const { return posed_; }  // trajectory.txt is there
    const std::filesystem::path& image(std::size_t index) const { return images_.at(index); }
    const Mat4& camera_to_world(std::size_t index) const { return poses_.at(index); }

    // Reads image `index` < size(). May be called from several threads at once. Throws Error(input)
    // naming the image where it is damaged, no 16-bit grey PNG, or of another size than
    // intrinsics().
    DepthFrame load(std::size_t index) const;

    // Unit mean of the cameras' upward axes (-y), world frame: where people hold cameras level, up
    // is near. Empty where the axes cancel out. Without a trajectory it is the one camera's.
    std::optional<Vec3> mean_camera_up() const;

  private:
    Intrinsics intrinsics_;
    std::vector<std::filesystem::path> images_;
    std::vector<Mat4> poses_;
    bool posed_ = false;
};

// Whether the path is a folder with depth/ or intrinsics.json in it. open() says what is missing.
bool looks_like_sequence(const std::filesystem::path& path);

// The parts of open() and load(), for tests.
Intrinsics read_intrinsics(const std::filesystem::path& file);
std::vector<Mat4> read_trajectory(const std::filesystem::path& file);
std::vector<std::uint16_t> read_depth_png(const std::filesystem::path& file, std::uint32_t width,
                                          std::uint32_t height);

}  // namespace topple::io
