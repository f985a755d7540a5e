// SPDX-License-Identifier: MIT
#include "export/object_surfaces.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "core/rotation.h"
#include "core/thread_pool.h"
#include "export/surface_colours.h"
#include "solids/object_voxels.h"
#include "solids/shaded_mesh.h"
#include "solids/simplify_mesh.h"
#include "solids/surface_mesh.h"

namespace topple {
namespace {

// How much simpler than they were found surfaces are made, in voxels: how far off they may be, and
// the longest edge where colours vary along it; and the share of the triangles that is left at
// least. (Of five scans, between a quarter and three fifths are at the first level.)
struct Level {
    double tolerance, coloured_edge, least_left;
};
// The next one is for what has more triangles than programs show, or simulators load, well.
constexpr std::array<Level, 3> shown_levels{{{0.01, 3, 0.25}, {0.03, 4, 0.2}, {0.1, 6, 0}}};
constexpr std::array<Level, 2> simulated_levels{{{0.1, 6, 0}, {0.2, 8, 0}}};
constexpr std::size_t most_triangles = 250'000;

std::size_t triangles_of(std::span<const solids::SurfaceMesh> meshes) {
    std::size_t out = 0;
    for (const solids::SurfaceMesh& mesh : meshes) out += mesh.triangle.size();
    return out;
}

std::vector<std::int32_t> objects_of(const Scene& scene) {
    std::vector<std::int32_t> out;
    for (const Primitive& p : scene.primitives) out.push_back(p.object);
    return out;
}

// The voxels of each object.
std::vector<std::span<const solids::ObjectVoxel>> by_object(
    std::span<const solids::ObjectVoxel> voxels) {
    std::vector<std::span<const solids::ObjectVoxel>> out;
    for (std::size_t first = 0, last = 0; first < voxels.size(); first = last) {
        while (last < voxels.size() && voxels[last].object == voxels[first].object) ++last;
        out.push_back(voxels.subspan(first, last - first));
    }
    return out;
}

}  // namespace

std::vector<ObjectSurface> object_surfaces(const Scene& scene, const SolidCells& cells,
                                           const BoundaryCells& boundary,
                                           const vdb::VoxelFrame& frame, unsigned threads,
                                           SurfaceDetail detail) {
    const std::span<const Level> levels =
        detail == SurfaceDetail::shown ? std::span<const Level>(shown_levels) : simulated_levels;
    const std::vector<std::int32_t> object_of = objects_of(scene);
    const auto voxels = solids::object_voxels(cells, boundary, object_of);
    const auto objects = by_object(voxels);
    std::optional<SurfaceColours> colours;
    if (!scene.points.red.empty()) colours.emplace(scene.points, cells, object_of, frame);
    ThreadPool pool(threads);
    std::vector<std::size_t> sizes;
    for (const auto& object : objects) sizes.push_back(object.size());
    std::vector<solids::SurfaceMesh> meshes(objects.size());
    pool.each_largest_first(sizes, [&](std::size_t n) {
        meshes[n] = solids::surface_mesh(objects[n], boundary, object_of, frame.voxel_m, pool);
    });
    const auto found = static_cast<double>(triangles_of(meshes));
    for (const Level& level : levels) {
        if (level.least_left * found > most_triangles) continue;  // it would not be enough
        pool.each_largest_first(sizes, [&](std::size_t n) {
            solids::simplify(meshes[n], boundary.patches,
                             {.tolerance_m = level.tolerance * frame.voxel_m,
                              .longest_m = colours ? level.coloured_edge * frame.voxel_m : 0},
                             pool);
        });
        if (triangles_of(meshes) <= most_triangles) break;
    }
    std::vector<ObjectSurface> out(objects.size());
    pool.each(objects.size(), 1, [&](std::size_t n) {
        const solids::SurfaceMesh& mesh = meshes[n];
        ObjectSurface& to = out[n];
        to.object = objects[n].front().object;
        auto shaded = solids::shaded(mesh, boundary.patches);
        for (Vec3& v : shaded.vertex) to.vertex.push_back(frame.input_of(v));
        for (Vec3& v : shaded.normal) to.normal.push_back(turned_back(frame.grid_from_input, v));
        to.triangle = std::move(shaded.triangle);
        for (const solids::Facet& f : mesh.facet) to.primitive.push_back(f.primitive);
        if (!colours) return;
        for (const std::uint32_t v : shaded.from)
            to.colour.push_back(colours->at(mesh.corner[v], to.object));
    });
    std::erase_if(out, [](const ObjectSurface& s) { return s.triangle.empty(); });
    return out;
}

}  // namespace topple
