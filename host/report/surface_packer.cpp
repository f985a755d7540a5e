// SPDX-License-Identifier: MIT
#include "report/surface_packer.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace topple::report {

std::uint8_t direction_code(const std::array<float, 3>& direction) {
    // Of a direction at 22.5 degrees to an axis, in its plane.
    constexpr float share = 0.4142f;
    const float most =
        std::max({std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2])});
    std::uint8_t code = 0;
    for (const std::size_t axis : {2, 1, 0}) {
        const float v = direction[axis];
        const int step = most > 0 && std::abs(v) > share * most ? (v > 0 ? 1 : -1) : 0;
        code = static_cast<std::uint8_t>(3 * code + step + 1);
    }
    return code;
}

namespace {

// A vertex, before it is known whether it is needed.
struct Vertex {
    const ObjectSurface* surface;
    std::uint32_t number;
    std::uint16_t group;
};

void add(const ObjectSurface& surface, const SurfaceRecords& records, std::vector<Vertex>& vertices,
         std::vector<std::array<std::uint16_t, 3>>& triangles) {
    std::vector<std::size_t> order(surface.triangle.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t t) { return surface.primitive[t]; });
    // The number of each vertex, good for the group at `begun` and after.
    std::vector<std::size_t> number(surface.vertex.size(), 0);
    std::size_t begun = vertices.size() + 1;
    std::int32_t primitive = -2;
    std::uint16_t group = 0;
    for (const std::size_t t : order) {
        if (surface.primitive[t] != primitive) {
            primitive = surface.primitive[t];
            group = records.group_of(surface, primitive);
            begun = vertices.size() + 1;
        }
        std::array<std::uint16_t, 3> index{};
        for (std::size_t n = 0; n < 3; ++n) {
            std::size_t& at = number[surface.triangle[t][n]];  // and 1
            // What is too far back comes once more.
            if (at < begun || vertices.size() + 1 - at > 65535) {
                vertices.push_back({&surface, surface.triangle[t][n], group});
                at = vertices.size();
                index[n] = 0;
            } else {
                index[n] = static_cast<std::uint16_t>(vertices.size() + 1 - at);
            }
        }
        triangles.push_back(index);
    }
}

}  // namespace

PackedSurface pack_surfaces(std::span<const ObjectSurface> surfaces, const SurfaceRecords& records,
                            std::size_t most, ThreadPool& pool) {
    PackedSurface out;
    std::vector<Vertex> vertices;
    for (const ObjectSurface& surface : surfaces) add(surface, records, vertices, out.index);
    if (vertices.size() * (records.coloured ? 16 : 12) + out.index.size() * 6 > most) return {};
    out.cell.resize(vertices.size());
    out.aux.resize(vertices.size());
    if (records.coloured) out.photo.resize(vertices.size());
    pool.each(vertices.size(), 4096, [&](std::size_t n) {
        const Vertex& from = vertices[n];
        const Record v = records.vertex_of(*from.surface, from.number, from.group);
        out.cell[n] = v.cell;
        out.aux[n] = v.aux;
        if (records.coloured) out.photo[n] = v.photo;
    });
    return out;
}

}  // namespace topple::report
