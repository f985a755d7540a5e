// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "topple/motion.h"

namespace topple::io {

// What a motion file holds, in its own units, axes and names.
struct NamedMotion {
    double step_s = 0;  // 0: not said
    std::vector<std::string> names;
    std::vector<std::vector<Vec3>> track;  // by name, then by frame
};

// Files with more numbers than this are refused: an hour at 120 Hz with 100 joints has as many.
inline constexpr std::uint64_t most_motion_numbers = 130'000'000;

NamedMotion read_bvh(const std::filesystem::path& file, std::string_view text);
NamedMotion read_joint_table(const std::filesystem::path& file, std::string_view text);

// The index among `names` of each BodyJoint, or npos. No name serves two joints.
std::array<std::size_t, body_joint_count> match_joints(const std::vector<std::string>& names);

}  // namespace topple::io
