// SPDX-License-Identifier: MIT
#include "solids/shaded_mesh.h"

#include <algorithm>

#include "core/rows.h"
#include "core/vectors.h"

namespace topple::solids {
namespace {

// A triangle's corner at a vertex.
struct Corner {
    std::size_t triangle, slot;
    Vec3 normal;  // 0 for a line that no patch tells of
    double area;
    bool known;         // by a patch
    std::size_t group;  // of those that share a normal: its first corner
};

// What turns more is a crease, cosines: between patches, and beside what no patch tells of.
constexpr double crease = 0.866, smoothed_crease = 0.7;

// Makes one of those that hang together without a crease; lines join the first.
void group(std::vector<Corner>& corners) {
    for (std::size_t a = 0; a < corners.size(); ++a) {
        corners[a].group = a;
        for (std::size_t b = 0; b < a; ++b) {
            const double least = corners[a].known && corners[b].known ? crease : smoothed_crease;
            if (corners[a].group == corners[b].group ||
                dot(corners[a].normal, corners[b].normal) < least)
                continue;
            const std::size_t to = std::min(corners[a].group, corners[b].group),
                              from = std::max(corners[a].group, corners[b].group);
            for (std::size_t c = 0; c <= a; ++c)
                if (corners[c].group == from) corners[c].group = to;
        }
    }
    const auto any =
        std::ranges::find_if(corners, [](const Corner& c) { return dot(c.normal, c.normal) > 0; });
    const std::size_t to = any == corners.end() ? 0 : any->group;
    for (Corner& c : corners)
        if (dot(c.normal, c.normal) == 0) c.group = to;
}

// The mean by area, of patches where there are any; where all are lines, that of one of a patch.
Vec3 normal_of(const std::vector<Corner>& corners, std::size_t group) {
    Vec3 sum{}, any{0, 0, 1};
    const bool known = std::ranges::any_of(
        corners, [&](const Corner& c) { return c.group == group && c.known && c.area > 0; });
    for (const Corner& c : corners) {
        if (c.group != group) continue;
        if (c.known) any = c.normal;
        if (known && !c.known) continue;
        for (std::size_t a = 0; a < 3; ++a) sum[a] += c.area * c.normal[a];
    }
    constexpr double least = 1e-200;  // squared
    return dot(sum, sum) > least ? unit(sum) : any;
}

}  // namespace

ShadedMesh shaded(const SurfaceMesh& mesh, std::span<const SurfacePatch> patches) {
    // Of each vertex, 3 times the triangle's number plus the slot.
    const Rows<std::size_t> corners_at(mesh.vertex.size(), [&](const auto& add) {
        for (std::size_t n = 0; n < 3 * mesh.triangle.size(); ++n)
            add(mesh.triangle[n / 3][n % 3], n);
    });
    ShadedMesh out;
    out.triangle.resize(mesh.triangle.size());
    std::vector<Corner> corners;
    std::vector<std::uint32_t> number;
    for (std::uint32_t v = 0; v < mesh.vertex.size(); ++v) {
        corners.clear();
        for (const std::size_t n : corners_at[v]) {
            const std::size_t t = n / 3;
            const auto& [a, b, c] = mesh.triangle[t];
            const Vec3& p = mesh.vertex[a];
            const Vec3 across = cross(minus(mesh.vertex[b], p), minus(mesh.vertex[c], p));
            const bool known = mesh.facet[t].patch != no_patch;
            const Vec3 normal = known ? outwards(mesh.facet[t], patches, mesh.vertex[v]) : across;
            corners.push_back({t, n % 3, unit(normal), length(across), known, 0});
        }
        group(corners);
        number.assign(corners.size(), 0);
        for (std::size_t n = 0; n < corners.size(); ++n) {
            if (corners[n].group != n) continue;
            number[n] = static_cast<std::uint32_t>(out.vertex.size());
            out.vertex.push_back(mesh.vertex[v]);
            out.normal.push_back(normal_of(corners, n));
            out.from.push_back(v);
        }
        for (const Corner& corner : corners)
            out.triangle[corner.triangle][corner.slot] = number[corner.group];
    }
    return out;
}

}  // namespace topple::solids
