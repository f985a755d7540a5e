// SPDX-License-Identifier: MIT
#include "export/sim_scene.h"

#include <algorithm>
#include <cmath>
#include <future>

#include "core/rotation.h"
#include "core/thread_pool.h"
#include "export/balance.h"
#include "export/brace.h"
#include "export/decompose.h"
#include "export/floor.h"
#include "export/merge_parts.h"
#include "export/object_surfaces.h"
#include "export/separate.h"
#include "export/simplify.h"
#include "export/stand.h"
#include "export/visual.h"
#include "physics/tipping.h"
#include "solids/cell_shape.h"
#include "topple/error.h"

namespace topple::exports {
namespace {

Mat3 turned_inertia(const Rotation& r, const Mat3& inertia) {
    Mat3 out{};
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
            for (std::size_t c = 0; c < 3; ++c)
                for (std::size_t d = 0; d < 3; ++d)
                    out[3 * a + b] += r[a][c] * inertia[3 * c + d] * r[b][d];
    return out;
}

// How far inside its footing the centre of mass is that has such a barrier.
double firm_m(const Object& object, const Body& body, double gravity_m_s2) {
    constexpr double most_m = 0.05;
    if (!(object.barrier_J > 0) || !(object.mass_kg > 0)) return 0;
    const double height = std::max(0.0, body.center_m[2] - box_around(body.parts).low[2]);
    const double rise = object.barrier_J / (object.mass_kg * gravity_m_s2);
    return std::min(most_m, physics::edge_distance_m(rise, height));
}

// The lowest of the level floors that are not much smaller than the largest: what else was taken
// for a floor are steps and rugs. Its place, which is that of none where there is none.
std::size_t main_floor(std::span<const Decomposed> solid) {
    constexpr double main_share = 0.25;
    double largest_m3 = 0;
    for (const Decomposed& each : solid)
        if (each.floor) largest_m3 = std::max(largest_m3, each.solid_m3);
    std::size_t found = solid.size();
    for (std::size_t n = 0; n < solid.size(); ++n) {
        if (!solid[n].floor || solid[n].solid_m3 < main_share * largest_m3) continue;
        if (found == solid.size() || solid[n].parts[0].high[2] < solid[found].parts[0].high[2])
            found = n;
    }
    return found;
}

// The bodies, and the main floor as it was seen, where there is one.
struct Bodies {
    std::vector<Body> all;
    std::optional<ConvexPart> floor;
};

Bodies bodies_of(const Scene& scene, const SolidScene& solids, ThreadPool& threads) {
    if (scene.primitives.size() != solids.primitives())
        throw Error(ErrorKind::input, "the scene has " + std::to_string(scene.primitives.size()) +
                                          " primitives, but its solids are of " +
                                          std::to_string(solids.primitives()));
    const std::vector<Clump> clumps = clumps_of(scene, solids.voxel_m());
    const std::vector<Decomposed> solid = decompose(solids, clumps, threads);
    const Rotation rotation = rotation_of(scene.manhattan_from_input);
    Bodies made;
    std::vector<Body>& out = made.all;
    for (const Object& object : scene.objects) {
        Body body;
        body.object = object.id;
        body.fixed = object.grounded;
        body.mass_kg = object.mass_kg;
        body.friction = object.friction;
        body.center_m = transformed(scene.manhattan_from_input, object.center_of_mass_m);
        body.inertia_kg_m2 = turned_inertia(rotation, object.inertia_kg_m2);
        out.push_back(std::move(body));
    }
    const std::size_t floor = main_floor(solid);
    for (std::size_t n = 0; n < clumps.size(); ++n) {
        Body& body = out.at(static_cast<std::size_t>(clumps[n].object));
        body.solid_m3 += solid[n].solid_m3;
        if (n != floor)
            body.parts.insert(body.parts.end(), solid[n].parts.begin(), solid[n].parts.end());
    }
    if (floor < solid.size()) {
        made.floor = solid[floor].parts[0];
        ConvexPart wide = *made.floor;
        widen_floor(wide, out, solids.voxel_m());
        auto& parts = out.at(static_cast<std::size_t>(clumps[floor].object)).parts;
        parts.insert(parts.begin(), std::move(wide));
    }
    merge_parts(out, solids.voxel_m(), threads);
    return made;
}

// What carries each body, and how far up that makes it; rings end where no level changes.
void add_supports(const Scene& scene, std::vector<Body>& bodies) {
    for (const Support& support : scene.supports) {
        bodies.at(static_cast<std::size_t>(support.supported))
            .carried_by.push_back(support.supporter);
    }
    for (std::size_t round = 0; round < bodies.size(); ++round) {
        bool changed = false;
        for (Body& body : bodies) {
            if (body.fixed) continue;
            int level = 1;
            for (const std::int32_t c : body.carried_by)
                level = std::max(level, bodies.at(static_cast<std::size_t>(c)).level + 1);
            level = std::min(level, static_cast<int>(bodies.size()));
            changed |= level != body.level;
            body.level = level;
        }
        if (!changed) break;
    }
}

SimScene without_visuals(const Scene& scene, const SolidScene& solids, bool joints,
                         ThreadPool& threads) {
    SimScene out;
    out.friction = scene.friction;
    Bodies made = bodies_of(scene, solids, threads);
    out.bodies = std::move(made.all);
    for (std::size_t n = 0; n < out.bodies.size(); ++n)
        out.bodies[n].firm_m = firm_m(scene.objects[n], out.bodies[n], out.gravity_m_s2);
    add_supports(scene, out.bodies);
    const double known_m = solids::form_error_m(solids.boundary(), solids.voxel_m());
    separate(out.bodies);
    settle(out.bodies, std::max(known_m, solids.voxel_m() / 2));
    separate(out.bodies);
    clear_sides(out.bodies);
    if (joints) out.fronts = place_fronts(out.bodies, fronts_of(scene), scene.density_kg_m3);
    // Cuts have added corners.
    for (Body& body : out.bodies)
        for (ConvexPart& part : body.parts)
            if (part.corner.size() > most_corners)
                part = simplified(std::move(part), fine_voxels * solids.voxel_m());
    brace(out.bodies, solids.voxel_m() / 2);
    keep_balance(out.bodies, {out.friction, out.gravity_m_s2, solids.voxel_m() / 2});
    joint_fronts(out.fronts, out.bodies);
    if (made.floor) {
        out.floor_m = made.floor->high[2];
        out.free_place = free_place(*made.floor, out.bodies);
    }
    return out;
}

}  // namespace

SimScene sim_scene(const Scene& scene, const SolidScene& solids, bool visuals, bool joints,
                   unsigned threads) {
    ThreadPool pool(threads);
    if (!visuals) return without_visuals(scene, solids, joints, pool);
    // Surfaces need nothing of the bodies.
    auto surfaces = std::async(threads == 1 ? std::launch::deferred : std::launch::async, [&] {
        return object_surfaces(scene, solids.with_strays(), solids.boundary(),
                               vdb::grid_frame(scene.manhattan_from_input, solids.voxel_m()),
                               threads, SurfaceDetail::simulated);
    });
    SimScene out = without_visuals(scene, solids, joints, pool);
    add_visuals(out, scene, surfaces.get());
    return out;
}

}  // namespace topple::exports
