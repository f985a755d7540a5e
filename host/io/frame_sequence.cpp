// SPDX-License-Identifier: MIT
#include "io/frame_sequence.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>

#include "io/json_problem.h"
#include "io/text.h"

namespace topple::io {
namespace fs = std::filesystem;
namespace {

constexpr std::uint32_t most_pixels_a_side = 32768;

double positive_number(const fs::path& file, const nlohmann::json& json, const char* key,
                       bool may_be_zero = false) {
    const auto found = json.find(key);
    if (found == json.end()) fail(file, std::string("has no \"") + key + "\"");
    if (!found->is_number()) {
        fail(file, std::string("\"") + key + "\" must be a number, not " + found->type_name());
    }
    const double value = found->get<double>();
    if (!std::isfinite(value) || value < 0 || (value == 0 && !may_be_zero)) {
        fail(file, std::string("\"") + key + "\" is " + short_number(value) + ", but must be " +
                       (may_be_zero ? "0 or more" : "above 0"));
    }
    return value;
}

std::uint32_t side(const fs::path& file, const nlohmann::json& json, const char* key) {
    const double value = positive_number(file, json, key);
    if (value != std::floor(value) || value > most_pixels_a_side) {
        fail(file, std::string("\"") + key + "\" is " + short_number(value) +
                       ", but must be a whole number from 1 to " +
                       std::to_string(most_pixels_a_side));
    }
    return static_cast<std::uint32_t>(value);
}

// The one file of poses that the folder has, if any.
std::optional<fs::path> find_trajectory(const fs::path& folder) {
    std::optional<fs::path> found;
    std::error_code error;
    for (const char* name : {"trajectory.txt", "trajectory.log", "poses.txt"}) {
        if (!fs::exists(folder / name, error)) continue;
        if (found) {
            fail(folder, "has both " + found->filename().string() + " and " + name +
                             "; keep the one whose poses are meant");
        }
        found = folder / name;
    }
    return found;
}

// depth/*.png by name; hidden files are other programs'.
std::vector<fs::path> list_images(const fs::path& folder) {
    const auto depth = folder / "depth";
    std::error_code error;
    if (!fs::is_directory(depth, error)) {
        fail(folder,
             "has no folder depth/; a sequence has depth/*.png, intrinsics.json and "
             "a trajectory.txt, trajectory.log or poses.txt");
    }
    std::vector<fs::path> images;
    fs::directory_iterator entry(depth, error);
    if (error) fail(depth, "can't be listed: " + error.message());
    for (; entry != fs::directory_iterator(); entry.increment(error)) {
        if (error) fail(depth, "can't be listed: " + error.message());
        auto extension = entry->path().extension().string();
        std::transform(extension.begin(), extension.end(), extension.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (extension == ".png" && entry->path().filename().native().front() != '.') {
            images.push_back(entry->path());
        }
    }
    if (error) fail(depth, "can't be listed: " + error.message());
    if (images.empty()) fail(depth, "has no .png; a sequence needs at least one depth image");
    std::sort(images.begin(), images.end(),
              [](const fs::path& a, const fs::path& b) { return a.native() < b.native(); });
    return images;
}

}  // namespace

Intrinsics read_intrinsics(const fs::path& file) {
    const auto bytes = read_file(file, 1 << 20);
    const auto text = bytes.text();
    nlohmann::json json;
    try {
        json = nlohmann::json::parse(text.begin(), text.end());
    } catch (const nlohmann::json::exception& error) {
        fail(file, "is no JSON: " + json_problem(error));
    }
    if (!json.is_object()) {
        fail(file, std::string("must hold a JSON object, not ") + json.type_name());
    }
    Intrinsics intrinsics;
    intrinsics.width = side(file, json, "width");
    intrinsics.height = side(file, json, "height");
    intrinsics.fx = positive_number(file, json, "fx");
    intrinsics.fy = positive_number(file, json, "fy");
    intrinsics.cx = positive_number(file, json, "cx", true);
    intrinsics.cy = positive_number(file, json, "cy", true);
    if (!json.contains("depth_scale")) {
        fail(file,
             "has no \"depth_scale\"; add it: metres = value / depth_scale, so 1000 for "
             "depth in millimetres");
    }
    intrinsics.depth_scale = positive_number(file, json, "depth_scale");
    if (intrinsics.cx > intrinsics.width || intrinsics.cy > intrinsics.height) {
        fail(file, "the principal point (" + short_number(intrinsics.cx) + ", " +
                       short_number(intrinsics.cy) + ") lies outside of the image of " +
                       std::to_string(intrinsics.width) + " x " +
                       std::to_string(intrinsics.height) + " pixels");
    }
    // At these ends 16 bits reach 65 km and 6.5 cm: beyond them the unit is wrong.
    if (intrinsics.depth_scale < 1 || intrinsics.depth_scale > 1e6) {
        fail(file, "\"depth_scale\" is " + short_number(intrinsics.depth_scale) +
                       ", but must be from 1 (depth in metres) to 1e+06 (micrometres)");
    }
    return intrinsics;
}

FrameSequence FrameSequence::open(const fs::path& folder) {
    FrameSequence sequence;
    sequence.images_ = list_images(folder);
    const auto intrinsics = folder / "intrinsics.json";
    std::error_code error;
    if (!fs::exists(intrinsics, error)) {
        fail(folder,
             "has no intrinsics.json; add one with width, height, fx, fy, cx, cy and "
             "depth_scale");
    }
    sequence.intrinsics_ = read_intrinsics(intrinsics);

    const auto trajectory = find_trajectory(folder);
    sequence.posed_ = trajectory.has_value();
    const auto frames = sequence.images_.size();
    if (trajectory) {
        sequence.poses_ = read_trajectory(*trajectory);
        if (sequence.poses_.size() != frames) {
            fail(*trajectory, "has " + counted(sequence.poses_.size(), "pose") + " for " +
                                  counted(frames, "depth image") + "; it must have one for each");
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

std::optional<Vec3> FrameSequence::mean_camera_up() const {
    Vec3 sum{};
    for (const auto& pose_of_camera : poses_) {
        for (std::size_t row = 0; row < 3; ++row) sum[row] -= pose_of_camera[row * 4 + 1];
    }
    const double length = std::hypot(sum[0], sum[1], sum[2]);
    if (length < 1e-3 * static_cast<double>(poses_.size())) return std::nullopt;
    return Vec3{sum[0] / length, sum[1] / length, sum[2] / length};
}

bool looks_like_sequence(const fs::path& path) {
    std::error_code error;
    return fs::is_directory(path, error) &&
           (fs::is_directory(path / "depth", error) || fs::exists(path / "intrinsics.json", error));
}

}  // namespace topple::io
