// SPDX-License-Identifier: MIT
#include "solids/surface_mesh.h"

#include <algorithm>
#include <map>

#include "core/vectors.h"
#include "solids/block_surface.h"
#include "solids/refine_mesh.h"
#include "solids/vertex_places.h"

namespace topple::solids {
namespace {

class Triangles {
  public:
    Triangles(std::span<const SurfacePatch> patches, SurfaceMesh& mesh)
        : patches_(patches), mesh_(mesh) {}

    void add(const VoxelFace& face, const Facet& facet) {
        const auto& v = face.vertex;
        if (face.pinched != 0) {
            add_pinched(face, facet);
            return;
        }
        // The diagonal beside which both triangles look outwards, the more so the better.
        Vec3 out{};
        out[face.axis()] = face.sign();
        if (facet.patch != no_patch) out = outwards(facet, patches_, mesh_.vertex[v[0]]);
        const auto area = [&](unsigned a, unsigned b, unsigned c) {
            const Vec3& p = mesh_.vertex[v[a]];
            return dot(cross(minus(mesh_.vertex[v[b]], p), minus(mesh_.vertex[v[c]], p)), out);
        };
        const bool other =
            std::min(area(0, 1, 3), area(1, 2, 3)) > std::min(area(0, 1, 2), area(0, 2, 3));
        add(facet, other ? std::array{v[0], v[1], v[3]} : std::array{v[0], v[1], v[2]});
        add(facet, other ? std::array{v[1], v[2], v[3]} : std::array{v[0], v[2], v[3]});
    }

  private:
    void add(const Facet& facet, const std::array<std::uint32_t, 3>& triangle) {
        mesh_.triangle.push_back(triangle);
        mesh_.facet.push_back(facet);
    }
    // A fan about the middle of a pinched edge.
    void add_pinched(const VoxelFace& face, const Facet& facet) {
        std::vector<std::uint32_t> border;
        std::size_t from = 0;
        for (unsigned n = 0; n < 4; ++n) {
            border.push_back(face.vertex[n]);
            if (!(face.pinched >> n & 1)) continue;
            from = border.size();
            border.push_back(middle_of(face.voxel, face.vertex[n], face.vertex[(n + 1) % 4]));
        }
        const auto at = [&](std::size_t n) { return border[(from + n) % border.size()]; };
        for (std::size_t n = 1; n + 1 < border.size(); ++n) add(facet, {at(0), at(n), at(n + 1)});
    }
    std::uint32_t middle_of(std::uint32_t voxel, std::uint32_t a, std::uint32_t b) {
        const auto next = static_cast<std::uint32_t>(mesh_.vertex.size());
        const auto [found, added] =
            middle_.try_emplace({voxel, std::min(a, b), std::max(a, b)}, next);
        if (added) {
            const Vec3 &p = mesh_.vertex[a], &q = mesh_.vertex[b];
            mesh_.vertex.push_back({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
            mesh_.corner.push_back(mesh_.corner[a]);
        }
        return found->second;
    }

    std::span<const SurfacePatch> patches_;
    SurfaceMesh& mesh_;
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> middle_;
};

}  // namespace

SurfaceMesh surface_mesh(std::span<const ObjectVoxel> voxels, const BoundaryCells& boundary,
                         std::span<const std::int32_t> object_of_primitive, double voxel_m,
                         ThreadPool& pool) {
    BlockSurface surface = block_surface(voxels);
    const ObjectEntries entries(boundary, object_of_primitive, voxel_m);
    const std::vector<Facet> facet = find_facets(voxels, surface.face, entries, pool);
    SurfaceMesh out;
    out.vertex = vertex_places(voxels, surface, facet, entries, boundary.patches, pool);
    out.corner = std::move(surface.corner);
    Triangles triangles(boundary.patches, out);
    for (std::size_t f = 0; f < surface.face.size(); ++f) triangles.add(surface.face[f], facet[f]);
    refine(out, boundary.patches, voxel_m, pool);
    return out;
}

}  // namespace topple::solids
