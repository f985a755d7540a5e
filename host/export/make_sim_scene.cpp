// SPDX-License-Identifier: MIT
#include "export/make_sim_scene.h"

#include <future>

#include "core/thread_pool.h"
#include "export/object_surfaces.h"
#include "export/visual.h"

namespace topple {
namespace {

vdb::VoxelFrame frame_of(const Scene& scene, const SolidScene& solids) {
    vdb::VoxelFrame out;
    out.voxel_m = solids.voxel_m();
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
            out.grid_from_input[a][b] = scene.manhattan_from_input[4 * a + b];
    return out;
}

}  // namespace

exports::SimScene make_sim_scene(const Scene& scene, const SolidScene& solids,
                                 const SimSceneOptions& options) {
    ThreadPool threads(options.threads);
    if (!options.visuals) return exports::sim_scene(scene, solids, threads);
    // Surfaces need nothing of the bodies.
    auto surfaces =
        std::async(options.threads == 1 ? std::launch::deferred : std::launch::async, [&] {
            return object_surfaces(scene, solids.with_strays(), solids.boundary(),
                                   frame_of(scene, solids), options.threads,
                                   SurfaceDetail::simulated);
        });
    exports::SimScene out = exports::sim_scene(scene, solids, threads);
    exports::add_visuals(out, scene, surfaces.get());
    return out;
}

}  // namespace topple
