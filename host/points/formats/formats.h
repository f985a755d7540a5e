// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "points/formats/cloud_builder.h"
#include "topple/input.h"

// One parser for each cloud format. `bytes` is the whole file; `file` is for messages only. With a
// sink the points go there, and the cloud returned has none.
namespace topple::io {

// PLY 1.0: ascii, binary_little_endian, binary_big_endian. Reads x y z, nx ny nz and red green blue
// (or diffuse_red and so on, or r g b; ColourScale says how bright) of any scalar type of the
// element `vertex`; skips every other property, list and element.
PointCloud parse_ply(const std::filesystem::path& file, std::string_view bytes,
                     const CloudSink* sink = nullptr);

// PCD 0.5 to 0.7: ascii, binary (the writer's byte order, taken as little-endian) and
// binary_compressed. Reads x y z, normal_x normal_y normal_z and rgb or rgba (0xAARRGGBB, as F or
// U); any other FIELDS are skipped.
PointCloud parse_pcd(const std::filesystem::path& file, std::string_view bytes,
                     const CloudSink* sink = nullptr);

// One point a line, separated by white space, commas or semicolons, of which commas may be those of
// decimals (text_columns.h); # and // start comments. A line of names may come first: then x, y, z
// (and nx, ny, nz, and r, g, b or red, green, blue) are found by name, in other words of surveyors
// and languages, too. Without one the first three columns are the point, and the next three of
// exactly six are normals if their length is 1, or colours if all are whole numbers from 0 to 255.
// A first line of one whole number is the count of points (.pts).
PointCloud parse_xyz(const std::filesystem::path& file, std::string_view bytes,
                     const CloudSink* sink = nullptr);

bool starts_as_las(std::string_view bytes);
// LAS 1.0 to 1.4, points of format 0 to 10, of which the coordinates and colours are read; withheld
// points are dropped. Where the first point lies beyond 4096 m, of which a unit has `unit_m`, all
// are moved by whole units so that it lies near the origin: see PointCloud::offset_m. LAZ is
// refused.
PointCloud parse_las(const std::filesystem::path& file, std::string_view bytes, double unit_m,
                     const CloudSink* sink = nullptr);

}  // namespace topple::io
