// SPDX-License-Identifier: MIT
#include "physics/body_landscape.h"

#include "physics/support_rows.h"
#include "topple/error.h"

namespace topple::physics {

std::vector<Vec3> vertices_of(const SupportTable::Rows& rows, const Candidate& candidate) {
    std::vector<Vec3> all;
    std::size_t count = 0;
    for (const std::int32_t p : candidate.primitives)
        count += rows.vertices[static_cast<std::size_t>(p)].size();
    all.reserve(count);
    for (const std::int32_t p : candidate.primitives) {
        const auto at = static_cast<std::size_t>(p);
        Vec3 offset{};
        for (std::size_t a = 0; a < 3; ++a) {
            offset[a] = rows.origin[at][a] - candidate.body.center[a];
        }
        for (const Vec3& v : rows.vertices[at]) {
            all.push_back({v[0] + offset[0], v[1] + offset[1], v[2] + offset[2]});
        }
    }
    return all;
}

Landscape body_landscape(const SupportTable& table, const Candidate& candidate) {
    const std::vector<Vec3> vertices = vertices_of(table.rows(), candidate);
    HullLandscape hull;
    try {
        hull = hull_landscape(vertices, {0, 0, 0},
                              {.resolution_m = table.rows().resolution_m, .borders = true});
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input) throw;
        return {};
    }
    const double weight_N = candidate.body.mass_kg * gravity;
    const auto joules = [&](double height_m) { return weight_N * (height_m - hull.now_m); };
    Landscape out;
    for (const std::uint32_t n : hull.corners) out.hull_m.push_back(vertices[n]);
    for (const HullPose& pose : hull.poses) {
        out.poses.push_back({pose.up, joules(pose.height_m), joules(pose.joins_at_m), pose.joins,
                             pose.probability});
    }
    for (HullPass& pass : hull.passes) {
        if (pass.poses[0] == pass.poses[1]) continue;
        out.passes.push_back({pass.up, joules(pass.height_m), pass.poses, std::move(pass.border)});
    }
    out.now = hull.now;
    return out;
}

}  // namespace topple::physics
