// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "points/formats/cloud_builder.h"
#include "points/formats/read_mesh.h"
#include "topple/input.h"

// Point clouds from files. Nothing in a file is trusted: sizes are checked against the file's
// before memory is taken for them, and every failure is an Error(input) of one line that names the
// file, the place in it, what was found and what was expected.
namespace topple::io {

// Reads a PLY, PCD or XYZ file, or the faces of a mesh as points (read_mesh.h), told apart by its
// first bytes and, where those say nothing, by its extension (.ply, .pcd; .xyz, .txt, .csv, .asc,
// .pts are XYZ; .obj, .stl, .glb, .gltf and a PLY with faces are meshes).
//
// Metres, the file's own frame: `unit_m` is how many metres its coordinates' unit has; of 1 it is
// the unit that the file states, if it does (stated_unit.h), with a note. Points with
// a coordinate that is not finite are left out and counted in `dropped`; a file without a finite
// point, or with a coordinate beyond 1e6 units, is refused. Normals are kept, made unit length,
// where the file has them (0, 0, 0 for single points without one).
PointCloud read_cloud(const std::filesystem::path& file, double unit_m = 1,
                      const MeshSampling& sampling = {});

// Notes how the points were moved, if they were.
void note_offset(PointCloud& cloud);

// What is to be said of the unit that such a file states, and that is taken where `unit_m` is 1,
// the default; "" where there is none, or it is the metre.
std::string unit_note_of(const std::filesystem::path& file, double unit_m);

// Where up is by the format of a file: glTF's is y.
std::optional<Vec3> up_of_format(const std::filesystem::path& file);

// Whether read_cloud() takes it for a mesh, or a cloud with faces. Throws Error(input) where it
// can't be opened.
bool is_mesh(const std::filesystem::path& file);

// Whether the file is a cloud, no mesh or map, by its extension.
bool can_stream(const std::filesystem::path& file);

// The same file in portions, for clouds larger than memory; its points come in its order. Returns a
// cloud without points, with what else there is to say: offset and notes. A binary_compressed PCD
// is unpacked whole; of a mesh's file the vertices come.
PointCloud stream_cloud(const std::filesystem::path& file, double unit_m, const CloudSink& sink);

}  // namespace topple::io
