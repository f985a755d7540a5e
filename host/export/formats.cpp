// SPDX-License-Identifier: MIT
#include "export/formats.h"

#include <array>
#include <string>

#include "export/writers.h"
#include "io/text.h"
#include "topple/error.h"

namespace topple::exports {
namespace {

constexpr std::array all_formats{
    Format{"mjcf", &ExportOptions::mjcf, "scene.xml",
           "Folder to write scene.xml into, MuJoCo's format", write_mjcf},
    Format{"urdf", &ExportOptions::urdf, "scene.urdf",
           "Folder to write scene.urdf into, for Bullet and ROS", write_urdf},
    Format{"sdf", &ExportOptions::sdf, "scene.sdf", "Folder to write scene.sdf into, for Gazebo",
           write_sdf},
    Format{"usd", &ExportOptions::usd, nullptr,
           "File to write, .usda, for Omniverse and others that read USD", write_usd},
};

}  // namespace

std::span<const Format> formats() {
    return all_formats;
}

std::filesystem::path scene_file(const Format& format, const std::filesystem::path& path) {
    return format.file ? path / format.file : path;
}

std::filesystem::path bodies_file(const Format& format, const std::filesystem::path& path) {
    if (format.file) return path / "bodies.json";
    return std::filesystem::path(path).replace_extension(".bodies.json");
}

void set_path(ExportOptions& options, std::string_view format, const std::filesystem::path& path) {
    if (path.empty())
        throw Error(ErrorKind::usage, std::string(format) + ": the path to write to is empty");
    std::string known;
    for (const Format& each : all_formats) {
        if (format == each.name) {
            options.*each.path = path;
            return;
        }
        if (!known.empty()) known += ", ";
        known += each.name;
    }
    throw Error(ErrorKind::usage,
                io::in_quotes(format) + " is no format of an export: expected one of " + known);
}

}  // namespace topple::exports
