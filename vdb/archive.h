// SPDX-License-Identifier: MIT
#pragma once

// Internal to vdb/.
#include <openvdb/openvdb.h>

#include <filesystem>

namespace topple::vdb {

// Writes grids as an OpenVDB file, of which equal grids make equal bytes. Throws Error(input) where
// the file can't be written.
void write_archive(const std::filesystem::path& path, const openvdb::GridPtrVec& grids,
                   const openvdb::MetaMap& meta);

}  // namespace topple::vdb
