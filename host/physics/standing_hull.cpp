// SPDX-License-Identifier: MIT
#include "physics/standing_hull.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "physics/merge_close_points.h"
#include "physics/tipping.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

double margin_m(const Candidate& candidate) {
    const Vec3& c = candidate.body.center;
    return footing(candidate.support_polygon, c[0], c[1]).margin_m;
}

// Relative to the centre of mass.
std::vector<Vec3> corners_of(const PartHulls& parts, const Candidate& candidate) {
    std::vector<Vec3> all;
    for (const std::int32_t p : candidate.primitives)
        for (const Vec3& v : parts.corners[p]) all.push_back(minus(v, candidate.body.center));
    return all;
}

std::vector<Vec3> cut_at_support(const Candidate& candidate, std::span<const Vec3> corners) {
    const Vec3& c = candidate.body.center;
    const double level = candidate.support_height_m - c[2];
    std::vector<Vec3> held;
    for (const Vec3& v : corners) held.push_back({v[0], v[1], std::max(v[2], level)});
    for (const auto& [x, y] : candidate.support_polygon)
        held.push_back({x - c[0], y - c[1], level});
    constexpr double alike_m = 1e-5;
    return merge_close_points(held, alike_m);
}

// Corners of cubes about all corners and the centre of mass.
std::vector<Vec3> widened(std::vector<Vec3> corners, double resolution_m) {
    constexpr double least = 1e-4;  // of its size
    double size = 0;
    for (const Vec3& v : corners) size = std::max(size, length(v));
    const double by = std::max({resolution_m / 2, least * size, least * least});
    corners.push_back({});
    std::vector<Vec3> out;
    for (const Vec3& v : corners)
        for (unsigned n = 0; n < 8; ++n)
            out.push_back(
                {v[0] + (n & 1 ? by : -by), v[1] + (n & 2 ? by : -by), v[2] + (n & 4 ? by : -by)});
    return out;
}

std::shared_ptr<HullWays> ways_of(std::span<const Vec3> corners) {
    return std::make_shared<HullWays>(corners, Vec3{0, 0, 1});
}

std::shared_ptr<HullWays> ways_of(const std::vector<Vec3>& corners, double resolution_m) {
    try {
        return ways_of(corners);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input) throw;
        return ways_of(widened(corners, resolution_m));
    }
}

// Contacts are known to a voxel or two, so that the hull may seem to rock by what is not known of
// them: by an angle of two voxels of height over the distance at which its footing holds it.
bool is_dent(const HullWays& ways, double margin_m, double resolution_m) {
    constexpr double largest_dent_rad = 0.5;
    const double angle =
        std::min(std::atan(2 * resolution_m / std::max(margin_m, resolution_m)), largest_dent_rad);
    return ways.rest()[2] >= std::cos(angle) &&
           ways.start_height() - ways.rest_height() <= 2 * resolution_m;
}

}  // namespace

bool is_held(const Candidate& candidate) {
    return !candidate.support_polygon.empty() && margin_m(candidate) > 0;
}

StandingHull standing_hull(const PartHulls& parts, const Candidate& candidate) {
    const double resolution_m = parts.resolution_m;
    const std::vector<Vec3> corners = corners_of(parts, candidate);
    if (corners.empty()) return {nullptr, resolution_m};
    // What hangs from above its centre of mass has no hull to cut there.
    const bool hangs = candidate.body.center[2] <= candidate.support_height_m;
    const bool can_be_cut = is_held(candidate) && !hangs;
    const auto cut = [&] { return ways_of(cut_at_support(candidate, corners), resolution_m); };
    if (candidate.stood && can_be_cut) return {cut(), resolution_m};
    std::shared_ptr<HullWays> ways = ways_of(corners, resolution_m);
    if (!can_be_cut || !(resolution_m > 0)) return {ways, resolution_m};
    // The hull would fall from a footing that holds the candidate.
    if (!is_dent(*ways, margin_m(candidate), resolution_m)) return {cut(), resolution_m};
    ways->settle();
    return {ways, resolution_m};
}

}  // namespace topple::physics
