// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "core/colour_space.h"
#include "io/file_writer.h"
#include "io/palette.h"
#include "topple/scene.h"

// The two clouds of a result, as binary little-endian PLY. Metres, input frame. Both throw
// Error(input) where the file can't be written, std::invalid_argument where arrays differ in
// length.
namespace topple::io {

// points.ply: x y z float, primitive object int, nx ny nz float (where there are normals),
// red green blue uchar: the scan's own, and object_red object_green object_blue by object; of a
// scan without colours those by object are red green blue.
void write_points_ply(const std::filesystem::path& file, const ScenePoints& points);

// The same of `count` points that come one by one. Throws Error(input), too, where more or fewer
// come.
class PointsPlyWriter {
  public:
    PointsPlyWriter(const std::filesystem::path& file, std::uint64_t count, bool coloured = false,
                    bool normals = false);
    // own: the point's colour in the scan, where there are any.
    void add(const std::array<float, 3>& point, std::int32_t primitive, std::int32_t object,
             const Rgb8& own = {}, const std::array<float, 3>& normal = {});
    void close();

  private:
    bool own_colours_, normals_;
    std::filesystem::path path_;
    FileWriter writer_;
    std::uint64_t left_;
    std::int32_t coloured_ = -1;  // the object that colour_ is of
    Rgb8 colour_ = colour_of(-1);
};

// solid.ply: x y z float, primitive object int, state uchar (0 seen surface, 1 completed),
// red green blue uchar by object.
void write_solid_ply(const std::filesystem::path& file, const SolidVoxels& voxels);

}  // namespace topple::io
