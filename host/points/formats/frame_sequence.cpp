// SPDX-License-Identifier: MIT
#include "points/formats/frame_sequence.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "io/open_file.h"
#include "io/text.h"
#include "points/formats/rigid_pose.h"

namespace topple::io {
namespace fs = std::filesystem;
namespace {

// The one file of poses that the folder has, if any.
std::optional<FileName> find_trajectory(const fs::path& folder) {
    std::optional<FileName> found;
    for (const char* name : {"trajectory.txt", "trajectory.log", "poses.txt"}) {
        const FileName file = FileName::in(folder, name);
        if (!file.is_there()) continue;
        if (found) {
            fail(folder, "has both " + found->path().filename().string() + " and " + name +
                             "; keep the one whose poses are meant");
        }
        found = file;
    }
    return found;
}

// depth/*.png by name; hidden files are other programs'.
std::vector<FileName> list_images(const fs::path& folder) {
    const fs::path depth = folder / "depth";
    std::error_code error;
    if (!fs::is_directory(depth, error)) {
        fail(folder,
             "has no folder depth/; a sequence has depth/*.png, intrinsics.json and "
             "a trajectory.txt, trajectory.log or poses.txt");
    }
    std::vector<std::string> images;
    const std::vector<std::string> names = folder_names(FileName::in(folder, "depth"), error);
    if (error) fail(depth, why_not_opened(error.value()));
    for (const fs::path name : names) {
        const std::string extension = lower_case(name.extension().string());
        if (extension == ".png" && name.native().front() != '.') images.push_back(name);
    }
    if (images.empty()) fail(depth, "has no .png; a sequence needs at least one depth image");
    std::sort(images.begin(), images.end());
    std::vector<FileName> files;
    for (const std::string& name : images)
        files.push_back(FileName::in(folder, fs::path("depth") / name));
    return files;
}

}  // namespace

FrameSequence FrameSequence::open(const fs::path& folder) {
    FrameSequence sequence;
    sequence.images_ = list_images(folder);
    const FileName intrinsics = FileName::in(folder, "intrinsics.json");
    if (!intrinsics.is_there()) {
        fail(folder,
             "has no intrinsics.json; add one with width, height, fx, fy, cx, cy and "
             "depth_scale");
    }
    sequence.intrinsics_ = read_intrinsics(intrinsics);
    sequence.colours_ = ColourFrames::open(folder, sequence.images_, sequence.intrinsics_);

    const auto trajectory = find_trajectory(folder);
    sequence.posed_ = trajectory.has_value();
    const auto frames = sequence.images_.size();
    if (trajectory) {
        sequence.poses_ = read_trajectory(*trajectory);
        if (sequence.poses_.size() != frames) {
            fail(trajectory->path(), "has " + counted(sequence.poses_.size(), "pose") + " for " +
                                         counted(frames, "depth image") +
                                         "; it must have one for each");
        }
    } else if (frames == 1) {
        sequence.poses_.push_back(DepthFrame{}.camera_to_world);
    } else {
        fail(folder,
             "has " + std::to_string(frames) +
                 " depth images but no trajectory.txt, trajectory.log or poses.txt; add one "
                 "with a pose per image (camera to world), or keep one image");
    }
    return sequence;
}

DepthFrame FrameSequence::load(std::size_t index) const {
    DepthFrame frame;
    frame.depth = read_depth_png(images_.at(index), intrinsics_.width, intrinsics_.height);
    frame.camera_to_world = poses_.at(index);
    return frame;
}

DepthFrame FrameSequence::load_coloured(std::size_t index) const {
    DepthFrame frame = load(index);
    frame.rgb = colours_.load(index);
    return frame;
}

std::vector<fs::path> FrameSequence::files(std::size_t index) const {
    std::vector<fs::path> out{images_.at(index).path()};
    if (const FileName* colours = colours_.file(index)) out.push_back(colours->path());
    return out;
}

std::optional<Vec3> FrameSequence::mean_camera_up() const {
    return io::mean_camera_up(poses_);
}

bool looks_like_sequence(const fs::path& path) {
    std::error_code error;
    return fs::is_directory(path, error) &&
           (fs::is_directory(path / "depth", error) || fs::exists(path / "intrinsics.json", error));
}

}  // namespace topple::io
