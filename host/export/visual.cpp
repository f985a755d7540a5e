// SPDX-License-Identifier: MIT
#include "export/visual.h"

#include <map>

#include "export/sim_scene.h"
#include "io/palette.h"
#include "physics/vectors.h"

namespace topple::exports {
namespace {

Vec3 in_world(const Mat4& m, const Vec3& v) {
    Vec3 out{};
    for (std::size_t a = 0; a < 3; ++a)
        out[a] = m[4 * a] * v[0] + m[4 * a + 1] * v[1] + m[4 * a + 2] * v[2];
    return out;
}

Visual visual_of(const ObjectSurface& surface, const Body& body, const Mat4& world_from_input) {
    Visual out;
    const Vec3 by = physics::minus(body.moved_m, body.center_m);
    out.vertex.reserve(surface.vertex.size());
    out.normal.reserve(surface.normal.size());
    out.colour.reserve(surface.vertex.size());
    for (const Vec3& v : surface.vertex)
        out.vertex.push_back(physics::along(in_world(world_from_input, v), 1, by));
    for (const Vec3& n : surface.normal) out.normal.push_back(in_world(world_from_input, n));
    const Rgb8 plain = io::colour_of(body.fixed && !body.held ? -1 : body.object);
    for (std::size_t n = 0; n < surface.vertex.size(); ++n)
        out.colour.push_back(surface.colour.empty() ? plain : surface.colour[n].value_or(plain));
    out.triangle = surface.triangle;
    return out;
}

}  // namespace

void add_visuals(SimScene& sim, const Scene& scene, std::span<const ObjectSurface> surfaces) {
    std::map<std::int32_t, const ObjectSurface*> of;
    for (const ObjectSurface& surface : surfaces) of.emplace(surface.object, &surface);
    for (Body& body : sim.bodies) {
        const auto found = of.find(body.object);
        if (body.object < 0 || found == of.end()) continue;
        body.visual = visual_of(*found->second, body, scene.manhattan_from_input);
    }
}

}  // namespace topple::exports
