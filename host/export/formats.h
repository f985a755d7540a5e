// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "export/sim_scene.h"
#include "topple/export.h"

namespace topple::exports {

// All that the interfaces need to know of a format: a new one is a line in formats.cpp, and its
// path in ExportOptions.
struct Format {
    const char* name;                            // "mjcf": of the option --mjcf, in C and in Python
    std::filesystem::path ExportOptions::*path;  // that the user names
    const char* file;                            // in that folder; null: the path is the file
    const char* help;                            // of the option
    void (*write)(const std::filesystem::path& path, const SimScene& scene);
};
std::span<const Format> formats();

// What it writes: the file that simulators open, and bodies.json beside it.
std::filesystem::path scene_file(const Format& format, const std::filesystem::path& path);
std::filesystem::path bodies_file(const Format& format, const std::filesystem::path& path);

// Sets the path of the format of that name. Throws Error(usage) that lists them where there is
// none.
void set_path(ExportOptions& options, std::string_view format, const std::filesystem::path& path);

}  // namespace topple::exports
