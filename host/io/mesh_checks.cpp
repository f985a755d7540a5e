// SPDX-License-Identifier: MIT
#include "io/mesh_checks.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/json_problem.h"
#include "io/ply_file.h"
#include "io/text.h"

namespace topple::io {
namespace {

using nlohmann::json;

std::uint32_t word(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= std::uint32_t(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    return value;
}

// A count or offset of glTF's JSON; `otherwise` where there is none.
std::uint64_t whole(const std::filesystem::path& file, const json& object, const char* key,
                    std::uint64_t otherwise) {
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    if (!found->is_number_unsigned()) {
        fail(file, std::string("\"") + key + "\" must be a whole number from 0 on, not " +
                       printable(found->dump(), 40));
    }
    return found->get<std::uint64_t>();
}

const json& list(const std::filesystem::path& file, const json& object, const char* key) {
    static const json none = json::array();
    const auto found = object.find(key);
    if (found == object.end()) return none;
    if (!found->is_array()) fail(file, std::string("\"") + key + "\" must be a list");
    for (const json& entry : *found) {
        if (!entry.is_object())
            fail(file, std::string("the entries of \"") + key + "\" must be objects");
    }
    return *found;
}

// Buffers hold their views, and views what is said to be in them.
void check_gltf(const std::filesystem::path& file, std::string_view text,
                std::optional<std::uint64_t> binary_bytes) {
    json root;
    try {
        root = json::parse(text.begin(), text.end());
    } catch (const json::exception& error) {
        fail(file, "holds no JSON of glTF: " + json_problem(error));
    }
    if (!root.is_object()) fail(file, "holds no glTF: its JSON is no object");
    std::vector<std::uint64_t> buffers, views;
    for (const json& buffer : list(file, root, "buffers")) {
        const auto bytes = whole(file, buffer, "byteLength", 0);
        const bool in_file = binary_bytes && buffers.empty() && !buffer.contains("uri");
        if (in_file && bytes > *binary_bytes) {
            fail(file, "its first buffer promises " + counted(bytes, "byte") +
                           ", but the file has " + std::to_string(*binary_bytes) +
                           " for it; it is cut short");
        }
        buffers.push_back(bytes);
    }
    for (const json& view : list(file, root, "bufferViews")) {
        const auto buffer = whole(file, view, "buffer", UINT64_MAX);
        const auto offset = whole(file, view, "byteOffset", 0);
        const auto bytes = whole(file, view, "byteLength", 0);
        if (buffer >= buffers.size() || offset > buffers[buffer] ||
            bytes > buffers[buffer] - offset) {
            fail(file, "buffer view " + std::to_string(views.size()) +
                           " reaches beyond its buffer; the file is damaged");
        }
        if (whole(file, view, "byteStride", 0) > 252)
            fail(file, "buffer view " + std::to_string(views.size()) +
                           " has a stride beyond glTF's limit of 252 bytes");
        views.push_back(bytes);
    }
    std::size_t number = 0;
    for (const json& accessor : list(file, root, "accessors")) {
        const std::string name = "accessor " + std::to_string(number++);
        if (accessor.contains("sparse")) fail(file, name + " is sparse, which is not read");
        const auto view = whole(file, accessor, "bufferView", UINT64_MAX);
        const auto offset = whole(file, accessor, "byteOffset", 0);
        const auto count = whole(file, accessor, "count", 0);
        if (view >= views.size() || offset > views[view] || count > views[view] - offset)
            fail(file, name + " promises more than its buffer view holds; the file is damaged");
    }
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

// A binary STL is 80 bytes of anything, a count, and 50 bytes a triangle.
void check_stl(const std::filesystem::path& file, std::string_view bytes) {
    const bool text = bytes.starts_with("solid") &&
                      bytes.substr(0, 1024).find("facet") != std::string_view::npos &&
                      bytes.substr(0, 1024).find('\0') == std::string_view::npos;
    if (text) return;
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
