// SPDX-License-Identifier: MIT
#include "points/formats/read_cloud.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "io/open_file.h"
#include "io/text.h"
#include "points/formats/cloud_builder.h"
#include "points/formats/formats.h"
#include "points/formats/stated_unit.h"

namespace topple::io {
namespace {

bool starts_as_ply(std::string_view bytes) {
    return bytes.starts_with("ply\n") || bytes.starts_with("ply\r\n") || bytes.starts_with("ply\r");
}

bool is_text(const std::string& extension) {
    constexpr std::array<std::string_view, 5> texts{".xyz", ".txt", ".csv", ".asc", ".pts"};
    return std::ranges::find(texts, extension) != texts.end();
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

// None of what begins as a cloud does, PLYs with faces among them.
std::optional<MeshFormat> mesh_format(std::string_view bytes, const std::string& extension) {
    if (starts_as_ply(bytes) || bytes.starts_with("# .PCD")) return std::nullopt;
    if (bytes.starts_with("glTF") || extension == ".glb") return MeshFormat::glb;
    if (extension == ".gltf") return MeshFormat::gltf;
    if (extension == ".obj") return MeshFormat::obj;
    if (extension == ".stl") return MeshFormat::stl;
    return std::nullopt;
}

// Whether a PLY's header promises faces.
bool ply_has_faces(std::string_view bytes) {
    Lines lines(bytes);
    for (std::string_view line; lines.next(line) && lines.number() < 20000;) {
        const auto keyword = next_token(line);
        if (keyword == "end_header") return false;
        if (keyword != "element" || next_token(line) != "face") continue;
        std::uint64_t count = 0;
        return parse_count(next_token(line), count) && count > 0;
    }
    return false;
}

// The faces of a PLY, where it has any that show a surface, else its vertices.
PointCloud parse_ply_or_mesh(const std::filesystem::path& file, std::string_view text,
                             double unit_m, const MeshSampling& sampling) {
    PointCloud cloud = parse_ply(file, text);
    if (!ply_has_faces(text)) return cloud;
    std::string reason = "they have no area";
    try {
        if (auto mesh = parse_mesh(file, text, MeshFormat::ply, unit_m, sampling))
            return *std::move(mesh);
    } catch (const Error& error) {
        reason = error.what();
    }
    cloud.notes.push_back(
        "The file's faces can't be used, so its vertices were taken alone: " + reason + ".");
    return cloud;
}

PointCloud parse_cloud(const std::filesystem::path& file, std::string_view text, double unit_m,
                       const MeshSampling& sampling, const CloudSink* sink = nullptr) {
    if (starts_as_ply(text))
        return sink ? parse_ply(file, text, sink) : parse_ply_or_mesh(file, text, unit_m, sampling);
    if (text.starts_with("# .PCD")) return parse_pcd(file, text, sink);

    const auto extension = lower_case(file.extension().string());
    if (const auto format = mesh_format(text, extension)) {
        auto mesh = parse_mesh(file, text, *format, unit_m, sampling);
        if (!mesh) fail(file, "is a mesh without any face that has an area");
        return *std::move(mesh);
    }
    if ((extension == ".ply" || extension == ".pcd") && starts_as_points(text)) {
        fail(file, "has no header, but lines of numbers; if these are points, name the file .xyz");
    }
    if (extension == ".ply") {
        fail(file, "starts with " + in_quotes(text.substr(0, 8)) +
                       ", where a PLY file starts with \"ply\"; it is another format or damaged");
    }
    if (extension == ".pcd") return parse_pcd(file, text, sink);
    if (starts_as_las(text) || extension == ".las" || extension == ".laz")
        return parse_las(file, text, unit_m, sink);
    if (is_text(extension)) return parse_xyz(file, text, sink);
    for (const char* known : {".e57", ".mcap", ".db3", ".bag", ".r3d", ".zip"}) {
        if (extension == known) {
            fail(file,
                 std::string("is read by topple.parse of Python only; make it one that is read "
                             "here: python3 -m topple.formats convert ") +
                     file.filename().string() + " OUT");
        }
    }
    fail(file, "is no known kind of point cloud or mesh (its extension is " + in_quotes(extension) +
                   "); give a .ply, .pcd, .xyz, .txt, .csv, .asc, .pts, .las, .obj, .stl, .glb, "
                   ".gltf, .bt, .ot or .vdb file, or a folder with depth/*.png");
}

// `unit_m` where it was asked for, else what the file says.
StatedUnit unit_of(const std::filesystem::path& file, std::string_view text, double unit_m) {
    if (unit_m != 1) return {{unit_m, unit_m, unit_m}, ""};
    const auto extension = lower_case(file.extension().string());
    std::optional<StatedUnit> stated;
    if (starts_as_las(text)) {
        stated = unit_of_las(file, text);
    } else if (extension == ".stl") {
        constexpr std::size_t header = 80;
        stated = unit_in_head(text.substr(0, header));
    } else if (!text.starts_with("glTF") && extension != ".gltf") {
        stated = unit_in_head(leading_comments(text));
        if (!stated && is_text(extension)) stated = unit_of_names(text);
    }
    return stated.value_or(StatedUnit{});
}

void scale(PointCloud& cloud, const StatedUnit& unit) {
    if (unit.metres == Vec3{1, 1, 1}) return;
    const std::array<std::array<std::vector<float>*, 2>, 3> axes{{{&cloud.x, &cloud.viewpoint_x},
                                                                  {&cloud.y, &cloud.viewpoint_y},
                                                                  {&cloud.z, &cloud.viewpoint_z}}};
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::vector<float>* values : axes[a])
            for (float& v : *values) v = static_cast<float>(v * unit.metres[a]);
        for (Vec3* place : {&cloud.viewpoint, &cloud.origin_m, &cloud.offset_m})
            (*place)[a] *= unit.metres[a];
    }
}

void note_unit(const StatedUnit& unit, PointCloud& cloud) {
    if (std::string note = unit_note(unit); !note.empty()) cloud.notes.push_back(std::move(note));
}

}  // namespace

void note_offset(PointCloud& cloud) {
    if (cloud.offset_m == Vec3{0, 0, 0}) return;
    cloud.notes.push_back(
        "The file's coordinates lie far from the origin, and were moved by " +
        vector_text({-cloud.offset_m[0], -cloud.offset_m[1], -cloud.offset_m[2]}) +
        " m, about; offset_m in scene.json has the exact way back.");
}

std::string unit_note_of(const std::filesystem::path& file, double unit_m) {
    const MappedFile bytes(file);
    return unit_note(unit_of(file, bytes.text(), unit_m));
}

bool is_mesh(const std::filesystem::path& file) {
    const MappedFile bytes(file);
    const std::string_view text = bytes.text();
    if (starts_as_ply(text)) return ply_has_faces(text);
    return mesh_format(text, lower_case(file.extension().string())).has_value();
}

std::optional<Vec3> up_of_format(const std::filesystem::path& file) {
    const MappedFile bytes(file);
    const auto format = mesh_format(bytes.text(), lower_case(file.extension().string()));
    if (format != MeshFormat::glb && format != MeshFormat::gltf) return std::nullopt;
    return Vec3{0, 1, 0};
}

bool can_stream(const std::filesystem::path& file) {
    const auto extension = lower_case(file.extension().string());
    return is_text(extension) || extension == ".ply" || extension == ".pcd" || extension == ".las";
}

PointCloud stream_cloud(const std::filesystem::path& file, double unit_m, const CloudSink& sink) {
    const MappedFile bytes(file);
    const StatedUnit unit = unit_of(file, bytes.text(), unit_m);
    const CloudSink scaled = [&](PointCloud portion) {
        scale(portion, unit);
        sink(std::move(portion));
        bytes.release();
    };
    PointCloud rest = parse_cloud(file, bytes.text(), unit.metres[0], {}, &scaled);
    scale(rest, unit);
    note_unit(unit, rest);
    note_offset(rest);
    return rest;
}

PointCloud read_cloud(const std::filesystem::path& file, double unit_m,
                      const MeshSampling& sampling) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) {
        fail(file,
             "is a folder without depth/ and intrinsics.json; give the file of a point cloud, mesh "
             "or "
             "map, or a folder with both");
    }
    const FileBytes bytes = read_file(file);
    const StatedUnit unit = unit_of(file, bytes.text(), unit_m);
    PointCloud cloud = parse_cloud(file, bytes.text(), unit.metres[0], sampling);
    scale(cloud, unit);
    note_unit(unit, cloud);
    note_offset(cloud);
    note_extent(cloud);
    return cloud;
}

}  // namespace topple::io
