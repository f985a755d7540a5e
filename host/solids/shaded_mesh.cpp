// SPDX-License-Identifier: MIT
#include "solids/shaded_mesh.h"

#include <limits>

#include "solids/vectors.h"

namespace topple::solids {

ShadedMesh shaded(const SurfaceMesh& mesh, std::span<const SurfacePatch> patches) {
    constexpr double crease = 0.866;  // cosine of 30 degrees
    // Each triangle's corners, in rows by vertex.
    struct Corner {
        std::size_t triangle, slot;
        Vec3 own, normal;
        double area;
    };
    std::vector<std::size_t> first(mesh.vertex.size() + 1, 0);
    for (const auto& t : mesh.triangle)
        for (const std::uint32_t v : t) ++first[v + 1];
    for (std::size_t v = 0; v < mesh.vertex.size(); ++v) first[v + 1] += first[v];
    std::vector<std::size_t> at(3 * mesh.triangle.size());
    {
        std::vector<std::size_t> next(first.begin(), first.end() - 1);
        for (std::size_t n = 0; n < at.size(); ++n) at[next[mesh.triangle[n / 3][n % 3]]++] = n;
    }
    ShadedMesh out;
    out.triangle.resize(mesh.triangle.size());
    std::vector<Corner> corners;
    for (std::uint32_t v = 0; v < mesh.vertex.size(); ++v) {
        corners.clear();
        for (std::size_t n = first[v]; n < first[v + 1]; ++n) {
            const std::size_t t = at[n] / 3;
            const auto& [a, b, c] = mesh.triangle[t];
            const Vec3& p = mesh.vertex[a];
            const Vec3 across = cross(minus(mesh.vertex[b], p), minus(mesh.vertex[c], p));
            const bool known = mesh.facet[t].patch != no_patch;
            corners.push_back({t, at[n] % 3,
                               unit(known ? outwards(mesh.facet[t], patches, mesh.vertex[v])
                                          : across),
                               {}, length(across)});
        }
        const std::size_t before = out.vertex.size();
        for (Corner& corner : corners) {
            Vec3 sum{}, all{};
            for (const Corner& other : corners) {
                const bool near = dot(other.own, corner.own) >= crease;
                for (std::size_t a = 0; a < 3; ++a) {
                    all[a] += other.area * other.own[a];
                    if (near) sum[a] += other.area * other.own[a];
                }
            }
            // Where the areas are 0, its own direction; where it has none, that of all.
            const double least = std::numeric_limits<double>::min();
            corner.normal = dot(sum, sum) > least               ? unit(sum)
                            : dot(corner.own, corner.own) > 0.5 ? corner.own
                            : dot(all, all) > least             ? unit(all)
                                                                : Vec3{0, 0, 1};
            std::size_t same = before;
            while (same < out.vertex.size() && dot(out.normal[same], corner.normal) < 1 - 1e-9)
                ++same;
            if (same == out.vertex.size()) {
                out.vertex.push_back(mesh.vertex[v]);
                out.normal.push_back(corner.normal);
                out.from.push_back(v);
            }
            out.triangle[corner.triangle][corner.slot] = static_cast<std::uint32_t>(same);
        }
    }
    return out;
}

}  // namespace topple::solids
