// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/output_folder.h"
#include "topple/input.h"

// Files of a scan. All throw Error(input) where they can't write.
namespace topple::scenes {

// 16 bit of grey, row by row.
void write_depth_png(const std::filesystem::path& path, std::uint32_t width,
                     const std::vector<std::uint16_t>& depth);
// 8 bit of red, green and blue.
void write_colour_png(const std::filesystem::path& path, std::uint32_t width,
                      const std::vector<std::array<std::uint8_t, 3>>& colour);
void write_text(const std::filesystem::path& path, const std::string& text);
void make_folder(const std::filesystem::path& folder);

// What `topple generate` makes, a scan with its truth.
extern const io::OutputKind generated_scan;

// The line of trajectory.txt for a pose, camera to world: t x y z qx qy qz qw.
std::string trajectory_line(double time_s, const Mat4& pose);
// What intrinsics.json holds.
std::string intrinsics_text(const Intrinsics& k);

}  // namespace topple::scenes
