// SPDX-License-Identifier: MIT
#include "points/formats/mesh_checks.h"

#include <string>

#include "io/text.h"
#include "points/formats/import_budget.h"
#include "points/formats/ply_file.h"
#include "points/formats/scalar.h"

namespace topple::io {
namespace {

// Each becomes a mesh of its own, with a node and a name of a kilobyte.
void check_stl_solids(const std::filesystem::path& file, std::string_view bytes) {
    constexpr std::uint64_t solid_bytes = 4096;
    std::uint64_t solids = 0;
    Lines lines(bytes);
    for (std::string_view line; lines.next(line);) solids += next_token(line) == "solid";
    ImportWeight(file, bytes.size()).add(solids, solid_bytes, "solid");
}

// A binary STL is 80 bytes of anything, a count, and 50 bytes a triangle.
void check_stl(const std::filesystem::path& file, std::string_view bytes) {
    const bool text = bytes.starts_with("solid") &&
                      bytes.substr(0, 1024).find("facet") != std::string_view::npos &&
                      bytes.substr(0, 1024).find('\0') == std::string_view::npos;
    if (text) return check_stl_solids(file, bytes);
    if (bytes.size() < 84) fail(file, "is no STL: it is shorter than the 84 bytes of its header");
    const auto triangles = value_at<std::uint32_t>(bytes, 80);
    const std::uint64_t need = 84 + std::uint64_t{50} * triangles;
    if (need != bytes.size()) {
        fail(file, "promises " + counted(triangles, "triangle") + ", which take " +
                       counted(need, "byte") + ", but has " + std::to_string(bytes.size()) +
                       "; it is cut short or no STL");
    }
}

}  // namespace

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

void check_mesh(const std::filesystem::path& file, std::string_view bytes, MeshFormat format) {
    if (format == MeshFormat::stl) check_stl(file, bytes);
    if (format == MeshFormat::ply) check_ply(file, bytes);
}

}  // namespace topple::io
