// SPDX-License-Identifier: MIT
#include "export/brace.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "export/footing.h"
#include "export/separate.h"
#include "export/stand.h"
#include "physics/infinity.h"
#include "physics/tipping.h"

namespace topple::exports {
namespace {

// Of the height of a body: a longer strut would be a post that nobody would have missed.
constexpr double longest_share = 0.5;
// Of the footing that the parse says a body has: so much is firm enough.
constexpr double firm_share = 0.5;

// An upright bar of a square section, from z up to a point.
std::optional<ConvexPart> bar(const Vec3& to, double z, double half_m) {
    const Extents<double> box{{to[0] - half_m, to[1] - half_m, z},
                              {to[0] + half_m, to[1] + half_m, to[2]}};
    return hull_part(box.corners());
}

// A bar under a body, of its own or of the world.
struct Strut {
    ConvexPart part;
    std::vector<Point2> foot;  // where it adds to the footing
    double length_m = 0;
    Point2 at{};
    // Where what it stands on is not level there: a level step on that, of that body.
    std::optional<ConvexPart> step{};
    std::size_t on = 0;
};

// Unless one that was added before is in the way.
void add(Strut strut, std::vector<Body>& bodies, Body& body) {
    if (meets(bodies, strut.part, body)) return;
    if (strut.step) {
        if (meets(bodies, *strut.step, bodies[strut.on])) return;
        bodies[strut.on].parts.push_back(*std::move(strut.step));
    }
    body.parts.push_back(std::move(strut.part));
}

// A strut below a body, which meets no other one but with its foot.
std::optional<Strut> strut_at(const std::vector<Body>& bodies, const std::vector<bool>& stands,
                              const Body& body, const Point2& at, double half_m) {
    constexpr double into_m = 1e-3;  // the body, so that it is one with it
    constexpr double level_m = 1e-4, border_m = 1e-3;
    const auto middle = gap_below(bodies, stands, body, at);
    if (!middle) return std::nullopt;
    double foot = middle->to_m, lowest = foot;
    for (const double x : {-half_m, half_m}) {
        for (const double y : {-half_m, half_m}) {
            const auto gap = gap_below(bodies, stands, body, {at[0] + x, at[1] + y});
            if (!gap) continue;
            foot = std::max(foot, gap->to_m);
            lowest = std::min(lowest, gap->to_m);
        }
    }
    if (foot > middle->from_m || foot - lowest > 4 * half_m) return std::nullopt;
    auto part = bar({at[0], at[1], middle->from_m + into_m}, foot, half_m);
    if (!part || meets(bodies, *part, body)) return std::nullopt;
    Strut out{*std::move(part), {}, middle->from_m - foot, at};
    out.on = middle->on;
    if (foot - lowest > level_m) {
        out.step = bar({at[0], at[1], foot}, lowest - into_m, half_m + border_m);
        if (!out.step || meets(bodies, *out.step, bodies[out.on])) return std::nullopt;
    }
    for (const Vec3& c : out.part.corner)
        if (c[2] < out.part.low[2] + 1e-9) out.foot.push_back({c[0], c[1]});
    return out;
}

// Of a level grid.
std::array<std::int64_t, 2> cell_of(double x, double y, double edge_m) {
    return {static_cast<std::int64_t>(std::floor(x / edge_m)),
            static_cast<std::int64_t>(std::floor(y / edge_m))};
}

// One corner for each cell of a grid: the lowest.
std::vector<Vec3> spread_low(const Body& body, double cell_m) {
    std::map<std::array<std::int64_t, 2>, Vec3> lowest;
    for (const ConvexPart& part : body.parts) {
        for (const Vec3& c : part.corner) {
            const auto [at, fresh] = lowest.try_emplace(cell_of(c[0], c[1], cell_m), c);
            if (!fresh && c[2] < at->second[2]) at->second = c;
        }
    }
    std::vector<Vec3> out;
    for (const auto& [cell, corner] : lowest) out.push_back(corner);
    return out;
}

// Slabs of the world under low corners of a body, the lowest first, where no body is in their way,
// itself included.
std::vector<Strut> posts_of(const std::vector<Body>& bodies, const Body& body, double half_m) {
    constexpr double thick_m = 0.002;
    const double lowest = box_around(body.parts).low[2];
    std::vector<Strut> out;
    for (const Vec3& c : spread_low(body, 2 * half_m)) {
        auto slab = bar({c[0], c[1], c[2]}, c[2] - thick_m, half_m);
        if (slab && !any_near(bodies, *slab, 0, [&](const Body& other, const ConvexPart& part) {
                return !other.fixed && overlap(*slab, part);
            }))
            out.push_back({*std::move(slab), {{c[0], c[1]}}, c[2] - lowest, {c[0], c[1]}});
    }
    std::ranges::stable_sort(out, {}, &Strut::length_m);
    return out;
}

// The shortest first. They are tried a little inwards of corners, where the body is widest.
std::vector<Strut> struts_of(const std::vector<Body>& bodies, const std::vector<bool>& stands,
                             const Body& body, double half_m, double longest_m) {
    std::vector<Point2> places;
    for (const ConvexPart& part : body.parts) {
        for (const Vec3& corner : part.corner) {
            Point2 at{corner[0], corner[1]};
            for (std::size_t a = 0; a < 2; ++a) {
                const double middle = (part.low[a] + part.high[a]) / 2;
                at[a] += std::clamp(middle - corner[a], -half_m, half_m);
            }
            places.push_back(at);
        }
    }
    // One for each cell of a grid.
    std::ranges::sort(places);
    std::set<std::array<std::int64_t, 2>> taken;
    std::vector<Strut> out;
    for (const Point2& at : places) {
        if (!taken.insert(cell_of(at[0], at[1], 2 * half_m)).second) continue;
        auto strut = strut_at(bodies, stands, body, at, half_m);
        if (strut && strut->length_m <= longest_m) out.push_back(*std::move(strut));
    }
    std::ranges::stable_sort(out, {}, &Strut::length_m);
    return out;
}

// The centre of mass of a body, and that with all it carries: both must stand.
struct Weights {
    Vec3 bare_m{}, laden_m{};
    double margin(const std::vector<Point2>& points) const {
        return std::min(margin_m(points, bare_m), margin_m(points, laden_m));
    }
};

// What several carry weighs on each alike.
std::vector<Weights> weights_of(const std::vector<Body>& bodies) {
    std::vector<double> mass_kg(bodies.size());
    std::vector<Weights> out(bodies.size());
    for (std::size_t n = 0; n < bodies.size(); ++n) {
        mass_kg[n] = bodies[n].mass_kg;
        out[n] = {bodies[n].center_m, bodies[n].center_m};
    }
    const std::vector<std::size_t> order = by_level(bodies);
    for (auto at = order.rbegin(); at != order.rend(); ++at) {
        const Body& above = bodies[*at];
        const double each_kg = mass_kg[*at] / static_cast<double>(above.carried_by.size());
        for (const std::int32_t c : above.carried_by) {
            const auto below = static_cast<std::size_t>(c);
            if (bodies[below].level >= above.level) continue;
            mass_kg[below] += each_kg;
            const double share = each_kg / mass_kg[below];
            Vec3& center = out[below].laden_m;
            for (std::size_t a = 0; a < 3; ++a)
                center[a] += share * (out[*at].laden_m[a] - center[a]);
        }
    }
    return out;
}

// Of struts, shortest first, as few and as short ones as make the footing firm, or as firm as all
// make it; nothing where all don't hold the body up.
std::vector<Strut> enough(const std::vector<Point2>& points, const Weights& weights,
                          std::vector<Strut> struts, double firm_m) {
    const auto margin_with = [&](const std::vector<bool>& used, std::size_t count) {
        std::vector<Point2> all = points;
        for (std::size_t n = 0; n < count; ++n)
            if (used[n]) all.insert(all.end(), struts[n].foot.begin(), struts[n].foot.end());
        return weights.margin(all);
    };
    std::vector<bool> used(struts.size(), true);
    std::size_t count = 0;
    double margin = weights.margin(points);
    while (margin < firm_m && count < struts.size()) {
        count = std::min(struts.size(), std::max<std::size_t>(4, 2 * count));
        margin = margin_with(used, count);
    }
    if (!(margin > 0)) return {};
    firm_m = std::min(firm_m, margin);
    for (std::size_t n = count; n-- > 0;) {
        used[n] = false;
        used[n] = margin_with(used, count) < firm_m;
    }
    std::vector<Strut> out;
    for (std::size_t n = 0; n < count; ++n)
        if (used[n]) out.push_back(std::move(struts[n]));
    return out;
}

double area_m2(const Point2& a, const Point2& b, const Point2& c) {
    return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
}

// Of struts, those at the corners of their hull: four, or more where each one that is left out
// would take much of its area away. A body stands as firmly on these as on all.
std::vector<Strut> corners_of(const std::vector<Strut>& struts) {
    constexpr std::size_t few = 4, most = 8;
    constexpr double little = 0.04;  // of the hull's area
    std::map<Point2, std::size_t> which;
    std::vector<Point2> hull;
    for (std::size_t n = 0; n < struts.size(); ++n) {
        which.emplace(struts[n].at, n);
        hull.push_back(struts[n].at);
    }
    hull = physics::convex_polygon(std::move(hull));
    double all_m2 = 0;
    for (std::size_t n = 1; n + 1 < hull.size(); ++n)
        all_m2 += area_m2(hull[0], hull[n], hull[n + 1]);
    while (hull.size() > few) {
        std::size_t least = 0;
        double least_m2 = physics::infinity;
        for (std::size_t n = 0; n < hull.size(); ++n) {
            const std::size_t last = (n + hull.size() - 1) % hull.size();
            const double lost_m2 = area_m2(hull[last], hull[n], hull[(n + 1) % hull.size()]);
            if (lost_m2 >= least_m2) continue;
            least = n;
            least_m2 = lost_m2;
        }
        if (hull.size() <= most && least_m2 > little * all_m2) break;
        hull.erase(hull.begin() + static_cast<std::ptrdiff_t>(least));
    }
    std::vector<Strut> out;
    for (const Point2& at : hull) out.push_back(struts[which.at(at)]);
    return out;
}

// Stands a body on feet at the corners of where it comes close to what carries it, with nothing
// else of it touching that; and where these are not firm on struts, besides. Whether it stands
// then.
bool set_on_feet(std::vector<Body>& bodies, const std::vector<bool>& stands, const Weights& weights,
                 std::size_t n, double half_m) {
    Body& body = bodies[n];
    const double firm = firm_share * body.firm_m;
    const Extents<double> box = box_around(body.parts);
    const double longest_m = std::max(longest_share * (box.high[2] - box.low[2]), 8 * half_m);
    const double close_m = 4 * half_m;
    std::vector<Strut> close, far;
    for (Strut& strut : struts_of(bodies, stands, body, half_m, longest_m))
        (strut.length_m <= close_m ? close : far).push_back(std::move(strut));
    std::vector<Strut> feet = corners_of(close);
    std::vector<Point2> points;
    for (const Strut& foot : feet) points.insert(points.end(), foot.foot.begin(), foot.foot.end());
    if (weights.margin(points) >= firm) {
        clear_below(bodies, body);
        for (Strut& foot : feet) add(std::move(foot), bodies, body);
        return true;
    }
    points = footing_of(bodies, stands, body);
    const double margin = weights.margin(points);
    if (margin >= firm) return true;
    close.insert(close.end(), std::move_iterator(far.begin()), std::move_iterator(far.end()));
    std::vector<Strut> more = enough(points, weights, std::move(close), firm);
    const bool holds = margin > 0 || !more.empty();
    body.struts += static_cast<int>(more.size());
    for (Strut& strut : more) add(std::move(strut), bodies, body);
    return holds;
}

// Whether parts come so close to one another.
bool within(const ConvexPart& a, const ConvexPart& b, double distance_m) {
    return near(a, b, distance_m) && apart(a, b).gap_m <= distance_m;
}

// Whether it touches something fixed beside it.
bool leans_on_fixed(const std::vector<Body>& bodies, const Body& body, double within_m) {
    return any_near(
        bodies, box_around(body.parts), within_m, [&](const Body& other, const ConvexPart& stays) {
            return other.fixed && std::ranges::any_of(body.parts, [&](const ConvexPart& part) {
                       return within(stays, part, within_m);
                   });
        });
}

// Whether anything is close below it, so that it was set down there and does not hang.
bool near_below(const std::vector<Body>& bodies, const Body& body) {
    constexpr double close_m = 0.1;
    Extents<double> below = box_around(body.parts);
    below.high[2] = below.low[2];
    below.low[2] -= close_m;
    return any_near(bodies, below, 0, [&](const Body& other, const ConvexPart& part) {
        return &other != &body && part.high[2] <= below.high[2] + close_m;
    });
}

// The first standing body with a part so close to a strut; the number of bodies where none has.
std::size_t beside(const std::vector<Body>& bodies, const std::vector<bool>& stands, std::size_t of,
                   const ConvexPart& strut, double within_m) {
    for (std::size_t n = 0; n < bodies.size(); ++n) {
        if (n == of || !stands[n]) continue;
        for (const ConvexPart& part : bodies[n].parts)
            if (within(part, strut, within_m)) return n;
    }
    return bodies.size();
}

// Lets what carries a body go on under low corners of it, by no more than what surfaces are known
// to: where posts of it lie. Whether the body, which has such a footing, stands then.
bool add_ledges(std::vector<Body>& bodies, const std::vector<bool>& stands, std::size_t n,
                const std::vector<Point2>& footing, const Weights& weights,
                const std::vector<Strut>& posts, double half_m) {
    std::vector<Strut> ledges;
    for (const Strut& post : posts) {
        const std::size_t on = beside(bodies, stands, n, post.part, 4 * half_m);
        if (on == bodies.size()) continue;
        if (!bodies[on].fixed && meets(bodies, post.part, bodies[on])) continue;
        ledges.push_back(post);
        ledges.back().on = on;
    }
    std::vector<Strut> taken =
        enough(footing, weights, std::move(ledges), firm_share * bodies[n].firm_m);
    for (Strut& ledge : taken) bodies[ledge.on].parts.push_back(std::move(ledge.part));
    return !taken.empty();
}

// Puts a body on a fixed pad, which together with a footing that it has makes it stand firmly: of
// its posts. False where none do.
bool pad_up(std::vector<Body>& bodies, std::size_t n, const std::vector<Point2>& footing,
            const Weights& weights, std::vector<Strut> posts) {
    Body& body = bodies[n];
    Body pad;
    pad.fixed = true;
    for (Strut& post : enough(footing, weights, std::move(posts), firm_share * body.firm_m))
        pad.parts.push_back(std::move(post.part));
    if (pad.parts.empty()) return false;
    body.on_pad = true;
    body.carried_by.push_back(static_cast<std::int32_t>(bodies.size()));
    bodies.push_back(std::move(pad));
    return true;
}

}  // namespace

void brace(std::vector<Body>& bodies, double thick_m) {
    std::vector<bool> stands(bodies.size());
    for (std::size_t n = 0; n < bodies.size(); ++n) stands[n] = bodies[n].fixed;
    const std::vector<Weights> weights = weights_of(bodies);
    for (const std::size_t n : by_level(bodies)) {
        // Of what falls by itself nothing is held up.
        if (bodies[n].fixed || bodies[n].parts.empty() || !(bodies[n].firm_m > 0)) continue;
        stands[n] = true;
        if (set_on_feet(bodies, stands, weights[n], n, thick_m / 2)) continue;
        const std::vector<Point2> footing = footing_of(bodies, stands, bodies[n]);
        std::vector<Strut> posts = posts_of(bodies, bodies[n], thick_m / 2);
        if (add_ledges(bodies, stands, n, footing, weights[n], posts, thick_m / 2)) continue;
        if ((near_below(bodies, bodies[n]) || !leans_on_fixed(bodies, bodies[n], thick_m)) &&
            pad_up(bodies, n, footing, weights[n], std::move(posts))) {
            stands.push_back(true);
            continue;
        }
        bodies[n].fixed = bodies[n].held = true;
    }
}

bool put_on_pad(std::vector<Body>& bodies, std::size_t body, double thick_m) {
    const std::vector<bool> all(bodies.size(), true);
    return pad_up(bodies, body, footing_of(bodies, all, bodies[body]), weights_of(bodies)[body],
                  posts_of(bodies, bodies[body], thick_m / 2));
}

}  // namespace topple::exports
