// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

// A process of its own for what may crash: files that other people's libraries read, and drivers.
namespace topple::child {

// Of these there are two, because OpenVDB alone takes four times longer to load than all the rest:
inline constexpr const char* reader_program = "topple-reader";         // meshes, OctoMaps, drivers
inline constexpr const char* volume_program = "topple-volume-reader";  // OpenVDB files

// Where one of them lies: in the folder that the environment variable TOPPLE_READERS names, if it
// is set; else beside the program, or the library, that holds this code, in libexec/topple beside
// their folder, or where it was installed at first. An absolute path. Empty: in none of these
// places. Throws Error(usage) where TOPPLE_READERS is set and it is not there.
std::filesystem::path find_program(const char* name);

}  // namespace topple::child
