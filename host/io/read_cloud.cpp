// SPDX-License-Identifier: MIT
#include "io/read_cloud.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <system_error>

#include "io/cloud_builder.h"
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

// Whether the first line that says anything is of three numbers or more.
bool starts_as_points(std::string_view bytes) {
    Lines lines(bytes.substr(0, 4096));
    for (std::string_view line; lines.next(line);) {
        std::size_t numbers = 0;
        double value;
        std::string_view token = next_token(line, true);
        if (token.empty()) continue;
        for (; parse_number(token, value); token = next_token(line, true)) ++numbers;
        return numbers >= 3 && token.empty();
    }
    return false;
}

PointCloud parse_cloud(const std::filesystem::path& file, std::string_view text) {
    if (starts_as_ply(text)) return parse_ply(file, text);
    if (text.starts_with("# .PCD")) return parse_pcd(file, text);

    const auto extension = lower_extension(file);
    if ((extension == ".ply" || extension == ".pcd") && starts_as_points(text)) {
        fail(file, "has no header, but lines of numbers; if these are points, name the file .xyz");
    }
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

void scale(PointCloud& cloud, double unit_m) {
    for (auto* values : {&cloud.x, &cloud.y, &cloud.z}) {
        for (float& v : *values) v = static_cast<float>(v * unit_m);
    }
    for (double& v : cloud.viewpoint) v *= unit_m;
}

}  // namespace

PointCloud read_cloud(const std::filesystem::path& file, double unit_m) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) {
        fail(file,
             "is a folder without depth/ and intrinsics.json; give a .ply, .pcd or .xyz file, "
             "or a folder with both");
    }
    PointCloud cloud = parse_cloud(file, read_file(file).text());
    if (unit_m != 1) scale(cloud, unit_m);
    note_extent(cloud);
    return cloud;
}

}  // namespace topple::io
