// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "io/file_writer.h"
#include "io/palette.h"
#include "topple/scene.h"

// The two clouds of a result, as binary little-endian PLY. Metres, input frame. Both throw
// Error(input) where the file can't be written, std::invalid_argument where arrays differ in
// length.
namespace topple::io {

// points.ply: x y z float, primitive object int, nx ny nz float (where there are normals),
// red green blue uchar by object.
void write_points_ply(const std::filesystem::path& file, const ScenePoints& points);

// points.ply without normals, of `count` points that come one by one. Throws Error(input), too,
// where more or fewer come.
class PointsPlyWriter {
  public:
    PointsPlyWriter(const std::filesystem::path& file, std::uint64_t count);
    void add(const std::array<float, 3>& point, std::int32_t primitive, std::int32_t object);
    void close();

  private:
    std::filesystem::path path_;
    FileWriter writer_;
    std::uint64_t left_;
    std::int32_t coloured_ = -1;  // the object that colour_ is of
    std::array<std::uint8_t, 3> colour_ = colour_of(-1);
};

// solid.ply: x y z float, primitive object int, state uchar (0 seen surface, 1 completed),
// red green blue uchar by object.
void write_solid_ply(const std::filesystem::path& file, const SolidVoxels& voxels);

}  // namespace topple::io
