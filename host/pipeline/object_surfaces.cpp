// SPDX-License-Identifier: MIT
#include "pipeline/object_surfaces.h"

#include <algorithm>
#include <span>
#include <thread>

#include "device/native/thread_pool.h"
#include "pipeline/surface_colours.h"
#include "solids/object_voxels.h"
#include "solids/shaded_mesh.h"
#include "solids/simplify_mesh.h"
#include "solids/surface_mesh.h"

namespace topple {
namespace {

// In voxels: how far a simpler surface may be from the one that was found, and the longest edge
// where colours vary along it.
constexpr double tolerance = 0.01, coloured_edge = 3;

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

Vec3 in_input(const vdb::VoxelFrame& frame, const Vec3& v) {
    Vec3 out{};
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t d = 0; d < 3; ++d) out[d] += frame.grid_from_input[a][d] * v[a];
    return out;
}

}  // namespace

std::vector<ObjectSurface> object_surfaces(const Scene& scene, const SolidCells& cells,
                                           const BoundaryCells& boundary,
                                           const vdb::VoxelFrame& frame, unsigned threads) {
    const std::vector<std::int32_t> object_of = objects_of(scene);
    const auto voxels = solids::object_voxels(cells, boundary, object_of);
    const auto objects = by_object(voxels);
    std::optional<SurfaceColours> colours;
    if (!scene.points.red.empty()) colours.emplace(scene.points, cells, object_of, frame);
    std::vector<ObjectSurface> out(objects.size());
    device::ThreadPool pool(threads > 0 ? threads
                                        : std::max(1U, std::thread::hardware_concurrency()));
    pool.each(objects.size(), 1, [&](std::size_t n) {
        ObjectSurface& to = out[n];
        to.object = objects[n].front().object;
        auto mesh = solids::surface_mesh(objects[n], boundary, object_of, frame.voxel_m);
        solids::simplify(mesh, boundary.patches,
                         {.tolerance_m = tolerance * frame.voxel_m,
                          .longest_m = colours ? coloured_edge * frame.voxel_m : 0});
        auto shaded = solids::shaded(mesh, boundary.patches);
        for (Vec3& v : shaded.vertex) to.vertex.push_back(in_input(frame, v));
        for (Vec3& v : shaded.normal) to.normal.push_back(in_input(frame, v));
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
