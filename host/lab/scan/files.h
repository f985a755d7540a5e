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
void make_folder(const std::filesystem::path& folder);

// What `topple generate` makes, a scan with its truth.
extern const io::OutputKind generated_scan;

// What intrinsics.json holds.
std::string intrinsics_text(const Intrinsics& k);

// depth/NNNN.png, color/NNNN.png where there are colours, intrinsics.json and, of several frames,
// trajectory.txt (TUM: time x y z qx qy qz qw, camera to world).
void write_frames(const std::filesystem::path& folder, const Intrinsics& k,
                  const std::vector<DepthFrame>& frames, double frames_per_s,
                  const std::vector<std::vector<std::array<std::uint8_t, 3>>>& colour = {});

// A binary .ply of `count` vertices x y z and whatever `properties` declare, as `bytes` holds them.
void write_ply(const std::filesystem::path& path, std::size_t count, const std::string& properties,
               const std::string& bytes);
void append_place(std::string& bytes, float x, float y, float z);

}  // namespace topple::scenes
