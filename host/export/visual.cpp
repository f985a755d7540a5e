// SPDX-License-Identifier: MIT
#include "export/visual.h"

#include <map>

#include "core/rotation.h"
#include "export/sim_scene.h"
#include "io/palette.h"

namespace topple::exports {
namespace {

// The building is grey.
Rgb8 plain_colour(const Body& body) {
    return io::colour_of(body.fixed && !body.held ? -1 : body.object);
}

Visual visual_of(const ObjectSurface& surface, const Body& body, const Mat4& world_from_input) {
    Visual out;
    const Vec3 by = minus(body.moved_m, body.center_m);
    out.vertex.reserve(surface.vertex.size());
    out.normal.reserve(surface.normal.size());
    out.colour.reserve(surface.vertex.size());
    for (const Vec3& v : surface.vertex)
        out.vertex.push_back(plus(transformed(world_from_input, v), by));
    for (const Vec3& n : surface.normal)
        out.normal.push_back(turned(rotation_of(world_from_input), n));
    const Rgb8 plain = plain_colour(body);
    for (std::size_t n = 0; n < surface.vertex.size(); ++n)
        out.colour.push_back(surface.colour.empty() ? plain : surface.colour[n].value_or(plain));
    out.triangle = surface.triangle;
    return out;
}

// The hulls of its parts.
Visual visual_of_parts(const Body& body) {
    Visual out;
    for (const ConvexPart& part : body.parts) {
        for (std::size_t side = 0; side < part.outline.size(); ++side) {
            const auto first = static_cast<std::uint32_t>(out.vertex.size());
            const auto count = static_cast<std::uint32_t>(part.outline[side].size());
            for (const std::uint32_t c : part.outline[side])
                out.vertex.push_back(minus(part.corner[c], body.center_m));
            for (std::uint32_t n = 1; n + 1 < count; ++n)
                out.triangle.push_back({first, first + n, first + n + 1});
            out.normal.insert(out.normal.end(), count, part.face[side].normal);
            out.colour.insert(out.colour.end(), count, plain_colour(body));
        }
    }
    return out;
}

double volume_m3(const Visual& visual) {
    double six = 0;
    for (const auto& [a, b, c] : visual.triangle)
        six += dot(visual.vertex[a], cross(visual.vertex[b], visual.vertex[c]));
    return six / 6;
}

}  // namespace

void add_visuals(SimScene& sim, const Scene& scene, std::span<const ObjectSurface> surfaces) {
    std::map<std::int32_t, const ObjectSurface*> of;
    for (const ObjectSurface& surface : surfaces) of.emplace(surface.object, &surface);
    // A surface that was simplified until it is flat holds nothing, which MuJoCo refuses.
    constexpr double least_m3 = 1e-9;
    for (Body& body : sim.bodies) {
        if (body.object < 0) continue;
        const auto found = of.find(body.object);
        if (found != of.end())
            body.visual = visual_of(*found->second, body, scene.manhattan_from_input);
        if (volume_m3(body.visual) < least_m3) body.visual = visual_of_parts(body);
    }
}

}  // namespace topple::exports
