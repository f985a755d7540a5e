// SPDX-License-Identifier: MIT
#include "points/formats/mesh_checks.h"

#include <string>

#include "io/text.h"
#include "points/formats/gltf_checks.h"
#include "points/formats/import_budget.h"
#include "points/formats/ply_file.h"

namespace topple::io {
namespace {

std::uint32_t word(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= std::uint32_t(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    return value;
}

void check_glb(const std::filesystem::path& file, std::string_view bytes) {
    if (bytes.size() < 20 || !bytes.starts_with("glTF"))
        fail(file, "is no GLB: it doesn't start with \"glTF\"");
    if (word(bytes, 4) != 2) {
        fail(file, "is GLB version " + std::to_string(word(bytes, 4)) + "; version 2 is read");
    }
    const std::uint64_t json_bytes = word(bytes, 12);
    if (word(bytes, 8) != bytes.size() || json_bytes > bytes.size() - 20) {
        fail(file, "its header promises " + counted(word(bytes, 8), "byte") +
                       ", but the file has " + std::to_string(bytes.size()) +
                       "; it is cut short or damaged");
    }
    std::uint64_t binary_bytes = 0;
    const std::uint64_t next = 20 + json_bytes;
    if (bytes.size() - next >= 8) {
        binary_bytes = word(bytes, next);
        if (binary_bytes > bytes.size() - next - 8) fail(file, "its binary part is cut short");
    }
    check_gltf(file, bytes.substr(20, json_bytes), binary_bytes);
}

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
    const std::uint64_t need = 84 + std::uint64_t{50} * word(bytes, 80);
    if (need != bytes.size()) {
        fail(file, "promises " + counted(word(bytes, 80), "triangle") + ", which take " +
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
    switch (format) {
        case MeshFormat::glb:
            return check_glb(file, bytes);
        case MeshFormat::gltf:
            return check_gltf(file, bytes, std::nullopt);
        case MeshFormat::stl:
            return check_stl(file, bytes);
        case MeshFormat::ply:
            return check_ply(file, bytes);
        case MeshFormat::obj:  // has no counts
            return;
    }
}

}  // namespace topple::io
