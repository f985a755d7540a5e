// SPDX-License-Identifier: MIT
#include "export/sim_scene.h"

#include <algorithm>
#include <cmath>

#include "export/decompose.h"
#include "export/merge_parts.h"
#include "export/separate.h"
#include "export/stand.h"
#include "physics/vectors.h"
#include "solids/cell_shape.h"
#include "topple/error.h"

namespace topple::exports {
namespace {

// Of a body's solid: what the hull of a piece may hold beyond it, and what joining parts may add.
constexpr double slight_of_object = 0.005, slight_of_ground = 0.001;
constexpr double merged_share = 0.05;

using Rotation = std::array<Vec3, 3>;  // rows

Rotation world_from_input(const Scene& scene) {
    const Mat4& m = scene.manhattan_from_input;
    return {Vec3{m[0], m[1], m[2]}, Vec3{m[4], m[5], m[6]}, Vec3{m[8], m[9], m[10]}};
}

Vec3 turned(const Rotation& r, const Vec3& v) {
    return {physics::dot(r[0], v), physics::dot(r[1], v), physics::dot(r[2], v)};
}

Mat3 turned(const Rotation& r, const Mat3& inertia) {
    Mat3 out{};
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
            for (std::size_t c = 0; c < 3; ++c)
                for (std::size_t d = 0; d < 3; ++d)
                    out[3 * a + b] += r[a][c] * inertia[3 * c + d] * r[b][d];
    return out;
}

// By primitive, see decompose().
std::vector<double> slight_m3(const Scene& scene) {
    std::vector<double> solid_m3(scene.objects.size(), 0), out;
    for (const Primitive& p : scene.primitives)
        if (p.object >= 0) solid_m3.at(static_cast<std::size_t>(p.object)) += p.volume_m3;
    for (const Primitive& p : scene.primitives) {
        const auto o = static_cast<std::size_t>(p.object);
        out.push_back(p.object < 0 ? -1
                                   : solid_m3[o] * (scene.objects[o].grounded ? slight_of_ground
                                                                              : slight_of_object));
    }
    return out;
}

std::vector<Body> bodies_of(const Scene& scene, const SolidScene& solids, ThreadPool& threads) {
    if (scene.primitives.size() != solids.primitives())
        throw Error(ErrorKind::input, "the scene has " + std::to_string(scene.primitives.size()) +
                                          " primitives, but its solids are of " +
                                          std::to_string(solids.primitives()));
    const std::vector<Decomposed> solid = decompose(solids, slight_m3(scene), threads);
    const Rotation rotation = world_from_input(scene);
    std::vector<Body> out;
    for (const Object& object : scene.objects) {
        Body body;
        body.object = object.id;
        body.fixed = object.grounded;
        body.mass_kg = object.mass_kg;
        body.center_m = turned(rotation, object.center_of_mass_m);
        body.inertia_kg_m2 = turned(rotation, object.inertia_kg_m2);
        for (const std::int32_t p : object.primitives) {
            const Decomposed& each = solid.at(static_cast<std::size_t>(p));
            body.solid_m3 += each.solid_m3;
            body.parts.insert(body.parts.end(), each.parts.begin(), each.parts.end());
        }
        out.push_back(std::move(body));
    }
    threads.each(out.size(), 1, [&](std::size_t n) {
        if (!out[n].fixed)
            merge_parts(out[n].parts, merged_share * out[n].solid_m3, solids.voxel_m());
    });
    return out;
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

}  // namespace

SimScene sim_scene(const Scene& scene, const SolidScene& solids, ThreadPool& threads) {
    SimScene out;
    out.friction = scene.friction;
    out.bodies = bodies_of(scene, solids, threads);
    add_supports(scene, out.bodies);
    const double known_m = solids::form_error_m(solids.boundary(), solids.voxel_m());
    separate(out.bodies);
    settle(out.bodies, std::max(known_m, solids.voxel_m() / 2));
    separate(out.bodies);
    flatten_feet(out.bodies, solids.voxel_m());
    return out;
}

}  // namespace topple::exports
