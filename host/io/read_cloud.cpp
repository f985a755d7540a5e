// SPDX-License-Identifier: MIT
#include "io/read_cloud.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <system_error>

#include "io/formats.h"
#include "io/text.h"

namespace topple::io {
namespace {

bool starts_as_ply(std::string_view bytes) {
    return bytes.starts_with("ply\n") || bytes.starts_with("ply\r\n") || bytes.starts_with("ply\r");
}

std::string lower_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

}  // namespace

PointCloud read_cloud(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) {
        fail(file,
             "is a folder without depth/ and intrinsics.json; give a .ply, .pcd or .xyz file, "
             "or a folder with both");
    }
    const auto bytes = read_file(file);
    const auto text = bytes.text();
    if (starts_as_ply(text)) return parse_ply(file, text);
    if (text.starts_with("# .PCD")) return parse_pcd(file, text);

    const auto extension = lower_extension(file);
    if (extension == ".ply") {
        fail(file, "starts with " + in_quotes(text.substr(0, 8)) +
                       ", where a PLY file starts with \"ply\"; it is another format or damaged");
    }
    if (extension == ".pcd") return parse_pcd(file, text);
    for (const char* known : {".xyz", ".txt", ".csv", ".asc", ".pts"}) {
        if (extension == known) return parse_xyz(file, text);
    }
    fail(file, "is no known kind of point cloud (its extension is " + in_quotes(extension) +
                   "); give a .ply, .pcd or .xyz file, or a folder with depth/*.png");
}

}  // namespace topple::io
