// SPDX-License-Identifier: MIT
#include "physics/standing_hull.h"

#include <algorithm>
#include <cmath>

#include "physics/merge_close_points.h"
#include "physics/tipping.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

double margin_m(const Candidate& candidate) {
    const Vec3& c = candidate.body.center;
    return footing(candidate.support_polygon, c[0], c[1]).margin_m;
}

std::vector<Vec3> cut_at_support(const Candidate& candidate, std::span<const Vec3> vertices) {
    const Vec3& c = candidate.body.center;
    const double level = candidate.support_height_m - c[2];
    std::vector<Vec3> held;
    for (const Vec3& v : vertices) held.push_back({v[0], v[1], std::max(v[2], level)});
    for (const auto& [x, y] : candidate.support_polygon)
        held.push_back({x - c[0], y - c[1], level});
    constexpr double alike_m = 1e-5;
    return merge_close_points(held, alike_m);
}

std::shared_ptr<HullWays> ways_of(std::span<const Vec3> vertices) {
    try {
        return std::make_shared<HullWays>(vertices, Vec3{0, 0, 1});
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input) throw;
        return nullptr;
    }
}

}  // namespace

std::vector<Vec3> vertices_of(const SupportTable::Rows& rows, const Candidate& candidate) {
    std::vector<Vec3> all;
    std::size_t count = 0;
    for (const std::int32_t p : candidate.primitives) count += rows.vertices[p].size();
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

bool is_held(const Candidate& candidate) {
    return !candidate.support_polygon.empty() && margin_m(candidate) > 0;
}

std::optional<double> dent_angle(const SupportTable::Rows& rows, const Candidate& candidate) {
    if (!(rows.resolution_m > 0) || !is_held(candidate)) return std::nullopt;
    const double margin = margin_m(candidate);
    return std::min(std::atan(2 * rows.resolution_m / std::max(margin, rows.resolution_m)), 0.5);
}

bool is_dent(const SupportTable::Rows& rows, double angle, const Vec3& bottom, double depth_m) {
    return bottom[2] >= std::cos(angle) && depth_m <= 2 * rows.resolution_m;
}

std::shared_ptr<const HullWays> standing_hull(const SupportTable::Rows& rows,
                                              const Candidate& candidate) {
    const std::vector<Vec3> vertices = vertices_of(rows, candidate);
    // What hangs from above its centre of mass has no hull to cut there.
    const bool hangs = candidate.body.center[2] <= candidate.support_height_m;
    if (candidate.stood && is_held(candidate) && !hangs)
        return ways_of(cut_at_support(candidate, vertices));
    std::shared_ptr<HullWays> ways = ways_of(vertices);
    const std::optional<double> angle = dent_angle(rows, candidate);
    if (!ways || !angle || hangs) return ways;
    const double depth = ways->start_height() - ways->rest_height();
    if (is_dent(rows, *angle, ways->rest(), depth)) {
        ways->settle();
        return ways;
    }
    // The hull would fall from a footing that holds the candidate.
    return ways_of(cut_at_support(candidate, vertices));
}

}  // namespace topple::physics
