// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "topple/input.h"

// How a person's body moves, as recorded: the secondary motion of the human field (paper, 5.1.2).
namespace topple {

enum class BodyJoint : std::uint8_t {
    pelvis,
    neck,
    head,
    left_shoulder,
    left_elbow,
    left_wrist,
    left_fingers,
    left_hip,
    left_knee,
    left_ankle,
    left_toes,
    right_shoulder,
    right_elbow,
    right_wrist,
    right_fingers,
    right_hip,
    right_knee,
    right_ankle,
    right_toes,
};
inline constexpr std::size_t body_joint_count = 19;

// Joint positions of one person at equal steps of time: metres, z up, any origin and heading.
struct BodyMotion {
    double step_s = 0;
    // By joint: its place in each frame, or empty where it was not recorded.
    std::array<std::vector<Vec3>, body_joint_count> track;
    std::string source;
    std::vector<std::string> notes;  // what was assumed, in sentences

    const std::vector<Vec3>& of(BodyJoint joint) const {
        return track[static_cast<std::size_t>(joint)];
    }
    std::size_t frames() const;  // 0 where nothing was recorded
    double stature_m() const;    // from the lengths of its legs, else of its arms; 0: neither known
};

// What a motion file does not say itself.
struct MotionFileOptions {
    std::optional<double> unit_m;   // metres in its unit; else found from the size of the body
    std::optional<double> rate_hz;  // frames a second, for tables without a column of times
    std::optional<Vec3> up;         // in its axes; else found from where head and feet are
};

// Reads a BVH file, or a table of joint positions: text with a first line of column names, such as
// time,left_wrist.x,left_wrist.y,left_wrist.z,... Names of joints are those of common motion
// capture systems; what has no counterpart above is left out. Throws Error: input, naming the file,
// the line and what is wrong; usage for options that make no sense.
BodyMotion read_motion(const std::filesystem::path& file, const MotionFileOptions& options = {});

}  // namespace topple
