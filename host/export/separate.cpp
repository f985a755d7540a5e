// SPDX-License-Identifier: MIT
#include "export/separate.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/vectors.h"
#include "physics/infinity.h"

namespace topple::exports {
namespace {

constexpr double touching_m = 1e-6;  // what overlaps less, touches
// What a part's hull holds beyond its solid costs so much of that.
constexpr double hollow = 0.02;
// What stands on something gives way to it, unless that costs so many times as much solid.
constexpr double standing = 4;
// Shares of a body's solid: what a cut may take before carving one part out of the other is thought
// of, and what another piece costs that this makes, of the part.
constexpr double dear = 0.02, another = 0.02;

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
            const Vec3 n = unit(across);
            if (gap_along(a, b, n) >= -touching_m || gap_along(a, b, opposite(n)) >= -touching_m)
                return true;
        }
    }
    return false;
}

// A plane between two parts, normal from the first to the second, and what it costs.
struct CuttingPlane {
    HalfSpace of_first;
    double cost = physics::infinity;
};

// Two parts that overlap, and what a cubic metre of the solid of each costs.
struct Overlap {
    const ConvexPart &a, &b;
    double a_costs, b_costs;
};

// The cheapest place of a plane of that normal. The parts' hulls overlap along it, their solids
// hardly.
CuttingPlane best_place(const Overlap& two, const Vec3& n) {
    std::vector<std::pair<double, double>> steps;  // at a place, what more is lost from there on
    const double low = extent_along(two.b, n).low, high = extent_along(two.a, n).high;
    const double each_a = two.a_costs * two.a.solid_each_m3;
    const double each_b = two.b_costs * two.b.solid_each_m3;
    double lost = 0;
    for (const Vec3& p : two.a.solid) {
        const double at = dot(n, p) - on_plane_m;
        if (at <= low) continue;
        lost += each_a;
        steps.emplace_back(at, -each_a);
    }
    for (const Vec3& p : two.b.solid)
        if (const double at = dot(n, p) + on_plane_m; at < high) steps.emplace_back(at, each_b);
    std::ranges::sort(steps);
    // Of places that cost the same, where the first part ends, or the second begins, or between.
    CuttingPlane best{{n, low}, lost};
    double last = low;
    for (const auto& [at, more] : steps) {
        const double place = std::clamp(at, low, high);
        if (lost < best.cost) best = {{n, (last + place) / 2}, lost};
        last = place;
        lost += more;
    }
    if (lost <= best.cost) best = {{n, high}, lost};
    return best;
}

double lost_m3(const ConvexPart& part, const HalfSpace& to) {
    const auto left = cut(part, to);
    return part.volume_m3 - (left ? left->volume_m3 : 0);
}

HalfSpace of_second(const CuttingPlane& plane) {
    return {opposite(plane.of_first.normal), -plane.of_first.offset_m};
}

CuttingPlane best_plane(const Overlap& two) {
    std::vector<std::pair<double, Vec3>> ways;
    each_direction(two.a, two.b, [&](const Vec3& n, double gap) { ways.emplace_back(gap, n); });
    std::ranges::stable_sort(ways, [](const auto& p, const auto& q) { return p.first > q.first; });
    constexpr std::size_t most_ways = 12;
    ways.resize(std::min(ways.size(), most_ways));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double sign : {1.0, -1.0}) {
            Vec3 n{};
            n[axis] = sign;
            ways.emplace_back(gap_along(two.a, two.b, n), n);
        }
    }
    CuttingPlane best;
    for (const auto& [gap, n] : ways) {
        CuttingPlane plane = best_place(two, n);
        if (plane.cost >= best.cost) continue;
        plane.cost += hollow * (two.a_costs * lost_m3(two.a, plane.of_first) +
                                two.b_costs * lost_m3(two.b, of_second(plane)));
        if (plane.cost < best.cost) best = plane;
    }
    return best;
}

// A part without another: convex pieces of it that hold what of its solid lies outside of that, and
// what is lost.
struct Carved {
    std::vector<ConvexPart> pieces;
    double cost = physics::infinity;
};

Carved carved(const ConvexPart& part, const ConvexPart& by, double costs) {
    constexpr std::size_t most_pieces = 6;
    Carved out{{}, 0};
    std::optional<ConvexPart> rest = part;
    // Each side is tried once: what lies beyond it may be too thin to be a piece.
    std::vector<const HalfSpace*> sides;
    for (const HalfSpace& side : by.face) sides.push_back(&side);
    while (rest && out.pieces.size() < most_pieces) {
        std::size_t most = 0;
        auto best = sides.end();
        for (auto at = sides.begin(); at != sides.end(); ++at) {
            const HalfSpace& side = **at;
            const auto outside =
                static_cast<std::size_t>(std::ranges::count_if(rest->solid, [&](const Vec3& p) {
                    return dot(side.normal, p) > side.offset_m + on_plane_m;
                }));
            if (outside <= most) continue;
            most = outside;
            best = at;
        }
        if (best == sides.end()) break;
        const HalfSpace side = **best;
        sides.erase(best);
        auto piece = cut(*rest, {opposite(side.normal), -side.offset_m});
        rest = cut(*rest, side);
        if (piece) out.pieces.push_back(*std::move(piece));
    }
    if (out.pieces.empty()) return {};
    double left = 0;
    for (const ConvexPart& piece : out.pieces) left += static_cast<double>(piece.solid.size());
    // Points on a plane count on both sides.
    const double lost = std::max(0.0, static_cast<double>(part.solid.size()) - left);
    const double whole = static_cast<double>(part.solid.size());
    out.cost = costs * part.solid_each_m3 *
               (lost + another * whole * static_cast<double>(out.pieces.size() - 1));
    return out;
}

// Puts pieces into the place of a part; those but the first come at the end. Whether none took its
// place, so that the next one did.
bool replace(Body& body, std::size_t& n, std::vector<ConvexPart> pieces) {
    double left_m3 = 0;
    for (const ConvexPart& piece : pieces) left_m3 += piece.volume_m3;
    body.lost_m3 += body.parts[n].volume_m3 - left_m3;
    if (pieces.empty()) {
        body.parts.erase(body.parts.begin() + static_cast<std::ptrdiff_t>(n));
        --n;
        return true;
    }
    body.parts[n] = std::move(pieces[0]);
    for (std::size_t k = 1; k < pieces.size(); ++k) body.parts.push_back(std::move(pieces[k]));
    return false;
}

std::vector<ConvexPart> pieces_in(const ConvexPart& part, const HalfSpace& to) {
    std::vector<ConvexPart> out;
    if (auto left = cut(part, to)) out.push_back(*std::move(left));
    return out;
}

// Parts two bodies, the first of which stands no higher.
void separate(Body& below, Body& above) {
    const bool carries = below.fixed || below.level < above.level;
    const double below_costs = carries ? standing : 1, above_costs = 1;
    const double dear_m3 = dear * std::min(below.solid_m3, above.solid_m3);
    for (std::size_t p = 0; p < below.parts.size(); ++p) {
        for (std::size_t q = 0; q < above.parts.size(); ++q) {
            const ConvexPart &a = below.parts[p], &b = above.parts[q];
            if (!near(a, b, 0) || !overlap(a, b)) continue;
            const CuttingPlane plane = best_plane({a, b, below_costs, above_costs});
            auto a_left = pieces_in(a, plane.of_first), b_left = pieces_in(b, of_second(plane));
            const bool ends = (a_left.empty() && below.parts.size() == 1) ||
                              (b_left.empty() && above.parts.size() == 1);
            if (ends || plane.cost > dear_m3) {
                const double limit = ends ? physics::infinity : plane.cost;
                Carved a_without = carved(a, b, below_costs), b_without = carved(b, a, above_costs);
                if (std::min(a_without.cost, b_without.cost) < limit) {
                    if (a_without.cost <= b_without.cost) {
                        replace(below, p, std::move(a_without.pieces));
                    } else {
                        replace(above, q, std::move(b_without.pieces));
                    }
                    continue;
                }
                if (ends) continue;
            }
            replace(above, q, std::move(b_left));
            if (replace(below, p, std::move(a_left))) break;
        }
    }
}

template <class Bodies, class Use>
void each_pair(Bodies& bodies, const Use& use) {
    struct Around {
        Extents<double> box;
        std::size_t body;
    };
    std::vector<Around> around;
    for (std::size_t n = 0; n < bodies.size(); ++n)
        if (!bodies[n].parts.empty()) around.push_back({box_around(bodies[n].parts), n});
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

constexpr double clear_m = 3e-4;

// Cuts what of a body touches another one in such a way.
template <class Way>
void clear(Body& body, const Body& other, const Way& way) {
    for (ConvexPart& part : body.parts) {
        for (const ConvexPart& stays : other.parts) {
            if (!near(part, stays, clear_m)) continue;
            const Apart lie = apart(stays, part);
            if (lie.gap_m < -touching_m || lie.gap_m >= clear_m || !way(lie)) continue;
            const double place = extent_along(stays, lie.normal).high + clear_m;
            if (auto left = cut(part, {opposite(lie.normal), -place})) part = *std::move(left);
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

Extents<double> box_around(std::span<const ConvexPart> parts) {
    Extents<double> box;
    for (const ConvexPart& part : parts) {
        box.add(part.low);
        box.add(part.high);
    }
    return box;
}

bool near(const Extents<double>& a, const Extents<double>& b, double distance_m) {
    for (std::size_t n = 0; n < 3; ++n)
        if (a.low[n] > b.high[n] + distance_m || b.low[n] > a.high[n] + distance_m) return false;
    return true;
}

bool meets(const std::vector<Body>& bodies, const ConvexPart& part, const Body& but) {
    return any_near(bodies, part, 0, [&](const Body& other, const ConvexPart& stays) {
        return &other != &but && overlap(part, stays);
    });
}

void separate(std::vector<Body>& bodies) {
    each_pair(bodies, [](Body& below, Body& above) { separate(below, above); });
}

void clear_sides(std::vector<Body>& bodies) {
    each_pair(bodies, [](const Body& below, Body& above) {
        clear(above, below,
              [](const Apart& lie) { return std::abs(lie.normal[2]) < carries_cosine; });
    });
}

void clear_below(const std::vector<Body>& bodies, Body& body) {
    const Extents<double> box = box_around(body.parts);
    for (const Body& other : bodies) {
        if (&other == &body || !near(box_around(other.parts), box, clear_m)) continue;
        clear(body, other, [](const Apart& lie) { return lie.normal[2] >= carries_cosine; });
    }
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
