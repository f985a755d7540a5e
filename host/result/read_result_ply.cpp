// SPDX-License-Identifier: MIT
#include "result/read_result_ply.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "io/open_file.h"
#include "io/text.h"
#include "points/formats/ply_file.h"

namespace topple::io {
namespace {

template <class T>
constexpr Scalar stored_as = std::is_same_v<T, float>          ? Scalar::f32
                             : std::is_same_v<T, std::int32_t> ? Scalar::i32
                                                               : Scalar::u8;

// The vertices of a binary PLY that holds nothing else, by property.
class ResultVertices {
  public:
    explicit ResultVertices(const FileName& file)
        : file_(file.path()), mapped_(file), header_(parse_ply_header(file_, mapped_.text())) {
        if (header_.encoding == PlyEncoding::ascii || header_.elements.size() != 1 ||
            header_.elements[0].name != "vertex" || header_.elements[0].has_lists())
            refuse();
        PlyItems items(file_, mapped_.text(), header_);
        items.expect(vertex());
        swapped_ = items.swapped();
    }

    template <class T>
    bool has(std::string_view name) const {
        return offset_of(name, stored_as<T>).has_value();
    }
    template <class T>
    void read(std::string_view name, std::vector<T>& to) const {
        const std::optional<std::size_t> offset = offset_of(name, stored_as<T>);
        if (!offset) refuse();
        const std::uint64_t item = vertex().least_bytes();
        const char* at = mapped_.text().data() + header_.data_offset + *offset;
        to.reserve(vertex().count);
        for (std::uint64_t i = 0; i < vertex().count; ++i, at += item)
            to.push_back(load_as<T>(at, swapped_));
        if constexpr (std::is_same_v<T, float>) {
            if (!std::ranges::all_of(to, [](float v) { return std::isfinite(v); }))
                fail(file_, "is damaged: its " + std::string(name) + " is not finite somewhere");
        }
    }

  private:
    const PlyElement& vertex() const { return header_.elements[0]; }
    [[noreturn]] void refuse() const {
        fail(file_, "is no " + file_.filename().string() + " that topple wrote");
    }
    // Where in a vertex a property of that name and type lies; nothing: it has none.
    std::optional<std::size_t> offset_of(std::string_view name, Scalar type) const {
        std::size_t offset = 0;
        for (const PlyProperty& property : vertex().properties) {
            if (property.name == name && property.type == type) return offset;
            offset += bytes_of(property.type);
        }
        return std::nullopt;
    }

    std::filesystem::path file_;
    MappedFile mapped_;
    PlyHeader header_;
    bool swapped_ = false;
};

template <class Points>
void read_labelled(const ResultVertices& vertices, Points& out) {
    vertices.read("x", out.x);
    vertices.read("y", out.y);
    vertices.read("z", out.z);
    vertices.read("primitive", out.primitive);
    vertices.read("object", out.object);
}

}  // namespace

ScenePoints read_points_ply(const FileName& file) {
    const ResultVertices vertices(file);
    ScenePoints out;
    read_labelled(vertices, out);
    if (vertices.has<float>("nx")) {
        vertices.read("nx", out.nx);
        vertices.read("ny", out.ny);
        vertices.read("nz", out.nz);
    }
    // Where a scan has no colours, red, green and blue are those of objects.
    if (vertices.has<std::uint8_t>("object_red")) {
        vertices.read("red", out.red);
        vertices.read("green", out.green);
        vertices.read("blue", out.blue);
    }
    return out;
}

SolidVoxels read_solid_ply(const FileName& file) {
    const ResultVertices vertices(file);
    SolidVoxels out;
    read_labelled(vertices, out);
    vertices.read("state", out.state);
    return out;
}

}  // namespace topple::io
