// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>

#include "core/space_map.h"

// Reading one file, whatever it holds: a cloud, a mesh or a map.
namespace topple::reader {

// Whether a library of other people's would read it: a mesh, an OctoMap or an OpenVDB file. Looks
// at its name and its first bytes. Throws Error(input) where it can't be opened.
bool takes_others(const std::filesystem::path& file);

// In this process. `space` is of a map only. poll: called now and then; what it throws ends the
// reading. Throws Error(input).
ScannedMap read_scan(const std::filesystem::path& file, double unit_m,
                     const std::function<void()>& poll);

// The same of all but OpenVDB files.
ScannedMap read_points(const std::filesystem::path& file, double unit_m,
                       const std::function<void()>& poll);

// As read_scan(); but what takes_others() is read by topple-reader or topple-volume-reader, in a
// process of its own, which may take memory and time by the file's size. What crashes there, or
// breaks its limits, is an Error(input) here; where there is no such program, or it does not start,
// Error(usage).
ScannedMap read_scan_apart(const std::filesystem::path& file, double unit_m,
                           const std::function<void()>& poll);

// What topple itself has written as volume.vdb (vdb::read_states()), read in such a process.
ScannedMap read_volume_apart(const std::filesystem::path& file, const std::function<void()>& poll);

}  // namespace topple::reader
