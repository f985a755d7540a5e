// SPDX-License-Identifier: MIT
#include "geometry/building.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/room_measures.h"
#include "geometry/shell_faces.h"
#include "geometry/storeys.h"

namespace topple::geometry {
namespace {

constexpr double histogram_step_m = 0.025;
// A kilometre of steps: no building is higher.
constexpr double most_height_m = 1000;
// A storey's floor lies within this much of its height.
constexpr double floor_off_m = 0.1;
// A wall's two faces: how thin it is, how well they look away from each other, and the area of each
// where they end at a ceiling; without one, where a shelf between two parts of a room may be as
// high, more.
constexpr double thinnest_wall_m = 0.03, opposite_cos = 0.97;
constexpr double wall_m2 = 3, open_wall_m2 = 6, open_wall_m = 2.2;

std::vector<Storey> storeys_of(const Surfels& s, const Vec3& up) {
    double low = INFINITY, high = -INFINITY;
    const auto height = [&](std::size_t n) { return component(up, s.x[n], s.y[n], s.z[n]); };
    for (std::size_t n = 0; n < s.size(); ++n) {
        low = std::min(low, height(n));
        high = std::max(high, height(n));
    }
    // Without a surfel it is negative.
    if (!(high - low >= 0 && high - low <= most_height_m))
        return find_storeys({}, 0, histogram_step_m);
    std::vector<double> area(static_cast<std::size_t>((high - low) / histogram_step_m) + 1, 0.0);
    for (std::size_t n = 0; n < s.size(); ++n)
        area[(height(n) - low) / histogram_step_m] += s.area_m2;
    return find_storeys(area, low, histogram_step_m);
}

bool has_floor(const std::vector<Face>& face, const Vec3& up, const Storey& storey) {
    double area = 0;
    for (const Face& f : face) {
        if (f.is_plane() && f.level(up) > horizontal_cos &&
            std::abs(f.height_m(up) - storey.floor_m) < floor_off_m)
            area += f.area_m2;
    }
    return area >= least_floor_m2;
}

// An upright face that may be a wall's, and how far it reaches along the wall.
struct Side {
    Face face;
    LevelSpan span;
};

std::vector<Side> find_sides(const Surfels& s, const std::vector<std::int32_t>& region,
                             const std::vector<Face>& face, const Vec3& up,
                             const StoreyHint& storey) {
    const double ceiling = ceiling_height(face, up, storey.floor_m, storey.top_m);
    const std::vector<LevelSpan> span = level_spans(s, region, face, up);
    std::vector<Side> out;
    for (std::size_t r = 0; r < face.size(); ++r) {
        const Face& f = face[r];
        const bool high =
            std::isfinite(ceiling)
                ? f.area_m2 >= wall_m2 && f.highest_m >= ceiling - below_ceiling_m
                : f.area_m2 >= open_wall_m2 && f.highest_m - f.lowest_m >= open_wall_m;
        if (high && f.is_plane() && f.is_upright(up)) out.push_back({f, span[r]});
    }
    return out;
}

bool is_wall(const Side& a, const Side& b) {
    const Face &f = a.face, &g = b.face;
    if (f.nx * g.nx + f.ny * g.ny + f.nz * g.nz > -opposite_cos) return false;
    const double thick = -((g.px - f.px) * f.nx + (g.py - f.py) * f.ny + (g.pz - f.pz) * f.nz);
    if (thick < thinnest_wall_m || thick > thickest_wall_m) return false;
    return gap_m(a.span, b.span, true) <= door_m;
}

bool has_inner_wall(const Surfels& surfels, const PrimitiveSet& primitives,
                    const std::vector<Face>& face, const Vec3& up, const StoreyHint& storey) {
    const std::vector<Side> sides = find_sides(surfels, primitives.faces.label, face, up, storey);
    for (std::size_t a = 0; a < sides.size(); ++a) {
        for (std::size_t b = a + 1; b < sides.size(); ++b)
            if (is_wall(sides[a], sides[b])) return true;
    }
    return false;
}

}  // namespace

std::vector<StoreyHint> find_building(const Surfels& surfels, const PrimitiveSet& primitives,
                                      const Vec3& up) {
    if (surfels.size() == 0) return {};
    const std::vector<Face> face =
        faces(surfels, primitives.faces.label, primitives.faces.regions.size(), up);
    std::vector<StoreyHint> out;
    for (const Storey& storey : storeys_of(surfels, up)) {
        // A slab without a floor on it ends no storey: a suspended ceiling, the tops of cupboards.
        if (!has_floor(face, up, storey)) continue;
        if (!out.empty()) out.back().top_m = storey.below_m;
        out.push_back({storey.floor_m,
                       out.empty() ? -std::numeric_limits<double>::infinity() : storey.below_m});
    }
    if (out.size() == 1 && !has_inner_wall(surfels, primitives, face, up, out.front())) out.clear();
    return out;
}

}  // namespace topple::geometry
