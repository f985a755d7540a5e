// SPDX-License-Identifier: MIT
#include "export/separate.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "physics/vectors.h"

namespace topple::exports {
namespace {

using physics::along;
using physics::cross;
using physics::dot;
using physics::minus;
using physics::opposite;

constexpr double touching_m = 1e-6;  // what overlaps less, touches
// What a part's hull holds beyond its solid costs so much of that.
constexpr double hollow = 0.02;
// What stands on something gives way to it, unless that costs so many times as much solid.
constexpr double standing = 4;

double gap_along(const ConvexPart& a, const ConvexPart& b, const Vec3& n) {
    return extent_along(b, n).low - extent_along(a, n).high;
}

// All directions in which two parts overlap least: those of their faces.
template <class Use>
void each_direction(const ConvexPart& a, const ConvexPart& b, const Use& use) {
    for (const HalfSpace& side : a.face)
        use(side.normal, extent_along(b, side.normal).low - side.offset_m);
    for (const HalfSpace& side : b.face)
        use(opposite(side.normal), -side.offset_m - extent_along(a, opposite(side.normal)).high);
}

// Edges of a part at the corner that lies furthest along n.
std::vector<Vec3> edges_at_end(const ConvexPart& part, const Vec3& n) {
    const auto furthest =
        std::ranges::max_element(part.corner, {}, [&](const Vec3& c) { return dot(n, c); });
    const auto corner = static_cast<std::uint32_t>(furthest - part.corner.begin());
    std::vector<Vec3> out;
    for (const auto& outline : part.outline) {
        const auto at = std::ranges::find(outline, corner);
        if (at == outline.end()) continue;
        const std::uint32_t next = at + 1 == outline.end() ? outline.front() : *(at + 1);
        out.push_back(minus(part.corner[next], *furthest));
    }
    return out;
}

// Whether two edges tell apart what no face does, of those that meet where the best of the faces'
// directions ends.
bool edges_apart(const ConvexPart& a, const ConvexPart& b, const Vec3& best) {
    for (const Vec3& u : edges_at_end(a, best)) {
        for (const Vec3& v : edges_at_end(b, opposite(best))) {
            const Vec3 across = cross(u, v);
            if (dot(across, across) < 1e-12 * dot(u, u) * dot(v, v)) continue;
            const Vec3 n = physics::unit(across);
            if (gap_along(a, b, n) >= -touching_m || gap_along(a, b, opposite(n)) >= -touching_m)
                return true;
        }
    }
    return false;
}

// A plane between two parts, normal from the first to the second, and what of their solids, times
// what that costs, lies beyond it.
struct Plane {
    HalfSpace of_first;
    double cost_m3 = physics::infinity;
};

// The cheapest place of a plane of that normal. The parts' hulls overlap along it, their solids
// hardly.
Plane best_place(const ConvexPart& a, const ConvexPart& b, const Vec3& n, double first_costs) {
    std::vector<std::pair<double, double>> steps;  // at a place, what more is lost from there on
    const double low = extent_along(b, n).low, high = extent_along(a, n).high;
    double lost = 0;
    for (const Vec3& p : a.solid) {
        const double at = dot(n, p) - on_plane_m;
        if (at <= low) continue;
        lost += first_costs * a.solid_each_m3;
        steps.emplace_back(at, -first_costs * a.solid_each_m3);
    }
    for (const Vec3& p : b.solid)
        if (const double at = dot(n, p) + on_plane_m; at < high)
            steps.emplace_back(at, b.solid_each_m3);
    std::ranges::sort(steps);
    // Of places that cost the same, where the first part ends, or the second begins, or between.
    Plane best{{n, low}, lost};
    double last = low;
    for (const auto& [at, more] : steps) {
        const double place = std::clamp(at, low, high);
        if (lost < best.cost_m3) best = {{n, (last + place) / 2}, lost};
        last = place;
        lost += more;
    }
    if (lost <= best.cost_m3) best = {{n, high}, lost};
    return best;
}

double lost_m3(const ConvexPart& part, const HalfSpace& to) {
    const auto left = cut(part, to);
    return part.volume_m3 - (left ? left->volume_m3 : 0);
}

Plane best_plane(const ConvexPart& a, const ConvexPart& b, double first_costs) {
    std::vector<std::pair<double, Vec3>> ways;
    each_direction(a, b, [&](const Vec3& n, double gap) { ways.emplace_back(gap, n); });
    std::ranges::stable_sort(ways, [](const auto& p, const auto& q) { return p.first > q.first; });
    constexpr std::size_t most_ways = 12;
    ways.resize(std::min(ways.size(), most_ways));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double sign : {1.0, -1.0}) {
            Vec3 n{};
            n[axis] = sign;
            ways.emplace_back(gap_along(a, b, n), n);
        }
    }
    Plane best;
    for (const auto& [gap, n] : ways) {
        Plane plane = best_place(a, b, n, first_costs);
        if (plane.cost_m3 >= best.cost_m3) continue;
        const HalfSpace of_second{opposite(n), -plane.of_first.offset_m};
        plane.cost_m3 += hollow * (lost_m3(a, plane.of_first) + lost_m3(b, of_second));
        if (plane.cost_m3 < best.cost_m3) best = plane;
    }
    return best;
}

// Takes from a part what lies beyond the plane; a body's last part stays as it is.
bool take(Body& body, std::size_t& n, const HalfSpace& to) {
    auto left = cut(body.parts[n], to);
    if (!left && body.parts.size() == 1) return false;
    body.lost_m3 += body.parts[n].volume_m3 - (left ? left->volume_m3 : 0);
    if (left) {
        body.parts[n] = *std::move(left);
        return false;
    }
    body.parts.erase(body.parts.begin() + static_cast<std::ptrdiff_t>(n));
    --n;  // the next one took its place
    return true;
}

// Parts two bodies, the first of which stands no higher.
void separate(Body& below, Body& above) {
    for (std::size_t p = 0; p < below.parts.size(); ++p) {
        for (std::size_t q = 0; q < above.parts.size(); ++q) {
            const ConvexPart &a = below.parts[p], &b = above.parts[q];
            if (!near(a, b, 0) || !overlap(a, b)) continue;
            const bool carries = below.fixed || below.level < above.level;
            const Plane plane = best_plane(a, b, carries ? standing : 1);
            const HalfSpace of_second{opposite(plane.of_first.normal), -plane.of_first.offset_m};
            take(above, q, of_second);
            if (take(below, p, plane.of_first)) break;
        }
    }
}

template <class Bodies, class Use>
void each_pair(Bodies& bodies, const Use& use) {
    struct Around {
        ConvexPart box;
        std::size_t body;
    };
    std::vector<Around> around;
    for (std::size_t n = 0; n < bodies.size(); ++n) {
        if (bodies[n].parts.empty()) continue;
        Around each{{}, n};
        each.box.low.fill(physics::infinity);
        each.box.high.fill(-physics::infinity);
        for (const ConvexPart& part : bodies[n].parts) {
            for (std::size_t a = 0; a < 3; ++a) {
                each.box.low[a] = std::min(each.box.low[a], part.low[a]);
                each.box.high[a] = std::max(each.box.high[a], part.high[a]);
            }
        }
        around.push_back(std::move(each));
    }
    std::ranges::stable_sort(around, [&](const Around& a, const Around& b) {
        return std::pair(!bodies[a.body].fixed, bodies[a.body].level) <
               std::pair(!bodies[b.body].fixed, bodies[b.body].level);
    });
    for (std::size_t a = 0; a < around.size(); ++a) {
        for (std::size_t b = a + 1; b < around.size(); ++b) {
            auto &first = bodies[around[a].body], &second = bodies[around[b].body];
            if ((first.fixed && second.fixed) || !near(around[a].box, around[b].box, 0)) continue;
            use(first, second);
        }
    }
}

}  // namespace

Apart apart(const ConvexPart& a, const ConvexPart& b) {
    Apart out{{}, -physics::infinity};
    each_direction(a, b, [&](const Vec3& n, double gap) {
        if (gap > out.gap_m) out = {n, gap};
    });
    return out;
}

double overlap_m(const ConvexPart& a, const ConvexPart& b) {
    const Apart lie = apart(a, b);
    return lie.gap_m < -touching_m && !edges_apart(a, b, lie.normal) ? -lie.gap_m : 0;
}

bool near(const ConvexPart& a, const ConvexPart& b, double distance_m) {
    for (std::size_t n = 0; n < 3; ++n)
        if (a.low[n] > b.high[n] + distance_m || b.low[n] > a.high[n] + distance_m) return false;
    return true;
}

void separate(std::vector<Body>& bodies) {
    each_pair(bodies, [](Body& below, Body& above) { separate(below, above); });
}

double deepest_overlap_m(const std::vector<Body>& bodies) {
    double deepest = 0;
    each_pair(bodies, [&](const Body& first, const Body& second) {
        for (const ConvexPart& a : first.parts)
            for (const ConvexPart& b : second.parts)
                if (near(a, b, 0)) deepest = std::max(deepest, overlap_m(a, b));
    });
    return deepest;
}

}  // namespace topple::exports
