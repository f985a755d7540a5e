// SPDX-License-Identifier: MIT
#pragma once

// Internal to vdb/.
#include <openvdb/openvdb.h>

#include <array>
#include <filesystem>
#include <string>

#include "topple/input.h"

namespace topple::vdb {

// The index (i, j, k) is the middle of a cell that spans corner_m + (i, j, k) by `along`.
openvdb::math::Transform::Ptr transform_of(const Vec3& corner_m, const std::array<Vec3, 3>& along);

void describe(openvdb::GridBase& grid, const std::string& name,
              const openvdb::math::Transform::Ptr& transform, double voxel_m);

// What a file of topple's says of itself.
openvdb::MetaMap about_file(const std::string& schema);

// Writes grids as an OpenVDB file, of which equal grids make equal bytes. Throws Error(input) where
// the file can't be written.
void write_archive(const std::filesystem::path& path, const openvdb::GridPtrVec& grids,
                   const openvdb::MetaMap& meta);

}  // namespace topple::vdb
