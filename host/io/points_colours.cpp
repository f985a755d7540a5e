// SPDX-License-Identifier: MIT
#include "io/points_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "io/mapped_file.h"
#include "io/ply_file.h"
#include "io/text.h"

namespace topple::io {
namespace {

// Where in a vertex a property of that name and type lies; nothing: it has none.
std::optional<std::size_t> offset_of(const PlyElement& vertex, std::string_view name, Scalar type) {
    std::size_t offset = 0;
    for (const PlyProperty& property : vertex.properties) {
        if (property.name == name && property.type == type) return offset;
        offset += bytes_of(property.type);
    }
    return std::nullopt;
}

}  // namespace

ScenePoints read_points_colours(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return {};
    const MappedFile mapped(file);
    const PlyHeader header = parse_ply_header(file, mapped.text());
    if (header.encoding == PlyEncoding::ascii || header.elements.size() != 1 ||
        header.elements[0].name != "vertex" || header.elements[0].has_lists())
        fail(file, "is no points.ply that topple wrote");
    const PlyElement& vertex = header.elements[0];
    // Where a scan has no colours, red, green and blue are those of objects.
    if (!offset_of(vertex, "object_red", Scalar::u8)) return {};
    static constexpr std::array<const char*, 3> axes{"x", "y", "z"},
        channels{"red", "green", "blue"};
    std::array<std::size_t, 3> point{}, colour{};
    const auto object = offset_of(vertex, "object", Scalar::i32);
    for (std::size_t a = 0; a < 3; ++a) {
        const auto at = offset_of(vertex, axes[a], Scalar::f32);
        const auto seen = offset_of(vertex, channels[a], Scalar::u8);
        if (!at || !seen || !object) fail(file, "is no points.ply that topple wrote");
        point[a] = *at;
        colour[a] = *seen;
    }
    PlyItems items(file, mapped.text(), header);
    items.expect(vertex);
    ScenePoints out;
    for (auto* each : {&out.x, &out.y, &out.z}) each->reserve(vertex.count);
    for (auto* each : {&out.red, &out.green, &out.blue}) each->reserve(vertex.count);
    out.object.reserve(vertex.count);
    const std::uint64_t item = vertex.least_bytes();
    const char* at = mapped.text().data() + header.data_offset;
    for (std::uint64_t i = 0; i < vertex.count; ++i, at += item) {
        std::array<float, 3> p;
        for (std::size_t a = 0; a < 3; ++a) p[a] = load_as<float>(at + point[a], items.swapped());
        if (!std::ranges::all_of(p, [](float v) { return std::isfinite(v); })) continue;
        out.x.push_back(p[0]);
        out.y.push_back(p[1]);
        out.z.push_back(p[2]);
        out.object.push_back(load_as<std::int32_t>(at + *object, items.swapped()));
        out.red.push_back(static_cast<std::uint8_t>(at[colour[0]]));
        out.green.push_back(static_cast<std::uint8_t>(at[colour[1]]));
        out.blue.push_back(static_cast<std::uint8_t>(at[colour[2]]));
    }
    return out;
}

}  // namespace topple::io
