// SPDX-License-Identifier: MIT
#pragma once

#include "export/sim_scene.h"
#include "host/export/blocks.h"
#include "host/export/round_parts.h"

namespace topple::exports::test {

// The surface of a block, each side with vertices of its own, of one colour.
inline Visual painted_block(const Vec3& low, const Vec3& high, const Rgb8& colour) {
    Visual out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool upper : {false, true}) {
            const auto first = static_cast<std::uint32_t>(out.vertex.size());
            const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (const auto& [at_u, at_v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
                Vec3& corner = out.vertex.emplace_back();
                corner[axis] = upper ? high[axis] : low[axis];
                corner[u] = at_u != 0 ? high[u] : low[u];
                corner[v] = at_v != 0 ? high[v] : low[v];
                Vec3& normal = out.normal.emplace_back();
                normal[axis] = upper ? 1 : -1;
                out.colour.push_back(colour);
            }
            for (std::array<std::uint32_t, 3> triangle :
                 {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 2, 3}}) {
                if (!upper) std::swap(triangle[1], triangle[2]);
                for (std::uint32_t& corner : triangle) corner += first;
                out.triangle.push_back(triangle);
            }
        }
    }
    return out;
}

// A cabinet's door, whose hinge is at the lower x, and the drawer above it. low, high: of the
// cabinet, whose front looks to -y.
inline std::vector<Front> door_and_drawer(const Vec3& low, const Vec3& high) {
    const double wide = high[0] - low[0], middle = (low[0] + high[0]) / 2,
                 parted = low[2] + 0.7 * (high[2] - low[2]);
    Front door;
    door.opening = Opening::hinge_at_low_u;
    door.probability = 0.9;
    door.out = {0, -1, 0};
    door.across = {1, 0, 0};
    door.wide_m = wide;
    door.high_m = parted - low[2];
    door.middle = {middle, low[1], (low[2] + parted) / 2};
    door.deep_m = high[1] - low[1];
    door.grip = {high[0] - 0.05, low[1] - 0.015, door.middle[2]};
    door.grip_m = {0.02, 0.03, 0.15};
    Front drawer = door;
    drawer.opening = Opening::slide;
    drawer.high_m = high[2] - parted;
    drawer.middle[2] = (parted + high[2]) / 2;
    drawer.grip = {middle, low[1] - 0.015, drawer.middle[2]};
    drawer.grip_m = {0.15, 0.03, 0.02};
    return {door, drawer};
}

// On a floor: a box and one on it, a lying cylinder, a ball, a ramp, a tilted box in the wall, and
// a cabinet with a door and a drawer; the boxes and the cabinet have a surface.
inline SimScene shapes_scene() {
    SimScene out;
    out.friction = 0.4;
    const auto add = [&](ConvexPart part, int level) -> Body& {
        Body& body = out.bodies.emplace_back(body_of(std::move(part), level, {}));
        body.object = static_cast<std::int32_t>(out.bodies.size()) - 1;
        // As of a box; turned a little, so that it is not diagonal.
        const Vec3 size = minus(body.parts[0].high, body.parts[0].low);
        const double m = body.mass_kg / 12;
        for (std::size_t a = 0; a < 3; ++a) {
            const double u = size[(a + 1) % 3], v = size[(a + 2) % 3];
            body.inertia_kg_m2[4 * a] = m * (u * u + v * v);
        }
        body.inertia_kg_m2[1] = body.inertia_kg_m2[3] = 0.05 * body.inertia_kg_m2[0];
        return body;
    };
    Body& ground = add(block({-1, -1, -0.1}, {1, 1, 0}), 0);
    ground.visual = painted_block({-1, -1, -0.05}, {1, 1, 0.05}, {200, 180, 160});
    const Vec3 half{0.1, 0.15, 0.1};
    for (const double z : {0.0, 0.2}) {
        Body& box = add(block({0, 0, z}, {0.2, 0.3, z + 0.2}), 1);
        box.visual = painted_block(opposite(half), half, {20, 100, 220});
    }
    add(*hull_part(prism({-0.5, 0, 0.1}, {0, 1, 0}, 0.1, 0.2, 64)), 1);
    add(*hull_part(ball({-0.5, 0.5, 0.05}, 0.05, 60)), 1);
    add(*cut(block({0.5, 0, 0}, {0.8, 0.3, 0.2}), {{0.6, 0, 0.8}, 0.55}), 1);
    ConvexPart tilted = *hull_part(prism({0.5, -0.5, 0.3}, {0.6, 0, 0.8}, 0.1, 0.2, 4));
    add(std::move(tilted), 0);
    out.bodies[2].friction = 0.7;  // of rubber
    const Vec3 low{-0.9, -0.9, 0}, high{-0.4, -0.5, 0.6};
    Body& cabinet = add(block(low, high), 1);
    std::vector<std::vector<Front>> fronts(out.bodies.size());
    fronts.back() = door_and_drawer(low, high);
    out.fronts = fronts_on_joints(out.bodies, fronts, 700);
    cabinet.visual =
        painted_block(minus(low, cabinet.center_m), minus(high, cabinet.center_m), {150, 110, 70});
    return out;
}

}  // namespace topple::exports::test
