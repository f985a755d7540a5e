// SPDX-License-Identifier: MIT
#include "export/brace.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "export/footing.h"
#include "export/separate.h"
#include "export/stand.h"

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
};

// A strut below a body, which meets no other one but with its foot.
std::optional<Strut> strut_at(const std::vector<Body>& bodies, const std::vector<bool>& stands,
                              const Body& body, const Point2& at, double half_m) {
    constexpr double into_m = 1e-3;  // the body, so that it is one with it
    const auto middle = gap_below(bodies, stands, body, at);
    if (!middle) return std::nullopt;
    double foot = middle->to_m;
    for (const double x : {-half_m, half_m})
        for (const double y : {-half_m, half_m})
            if (const auto gap = gap_below(bodies, stands, body, {at[0] + x, at[1] + y}))
                foot = std::max(foot, gap->to_m);
    if (foot > middle->from_m) return std::nullopt;
    auto strut = bar({at[0], at[1], middle->from_m + into_m}, foot, half_m);
    if (!strut || any_near(bodies, *strut, 0, [&](const Body& other, const ConvexPart& part) {
            return &other != &body && overlap(*strut, part);
        }))
        return std::nullopt;
    std::vector<Point2> feet;
    for (const Vec3& c : strut->corner)
        if (c[2] < strut->low[2] + 1e-9) feet.push_back({c[0], c[1]});
    return Strut{*std::move(strut), std::move(feet), middle->from_m - foot};
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
            out.push_back({*std::move(slab), {{c[0], c[1]}}, c[2] - lowest});
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

// Adds struts where the footing is not firm. Whether the body stands then.
bool add_struts(const std::vector<Body>& bodies, const std::vector<bool>& stands,
                const Weights& weights, Body& body, double half_m) {
    const std::vector<Point2> points = footing_of(bodies, stands, body);
    const double firm = firm_share * body.firm_m, margin = weights.margin(points);
    if (margin >= firm) return true;
    const Extents<double> box = box_around(body.parts);
    const double longest_m = std::max(longest_share * (box.high[2] - box.low[2]), 8 * half_m);
    for (Strut& strut :
         enough(points, weights, struts_of(bodies, stands, body, half_m, longest_m), firm)) {
        body.parts.push_back(std::move(strut.part));
        ++body.struts;
    }
    return margin > 0 || body.struts > 0;
}

// Whether it touches something fixed beside it.
bool leans_on_fixed(const std::vector<Body>& bodies, const Body& body, double within_m) {
    return any_near(
        bodies, box_around(body.parts), within_m, [&](const Body& other, const ConvexPart& stays) {
            return other.fixed && std::ranges::any_of(body.parts, [&](const ConvexPart& part) {
                       return near(part, stays, within_m) && apart(stays, part).gap_m <= within_m;
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

// Puts a body on a fixed pad, which together with a footing that it has makes it stand firmly:
// slabs under low corners of it. False where none do.
bool pad_up(std::vector<Body>& bodies, std::size_t n, const std::vector<Point2>& footing,
            const Weights& weights, double half_m) {
    Body& body = bodies[n];
    Body pad;
    pad.fixed = true;
    for (Strut& post :
         enough(footing, weights, posts_of(bodies, body, half_m), firm_share * body.firm_m))
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
        if (add_struts(bodies, stands, weights[n], bodies[n], thick_m / 2)) continue;
        if ((near_below(bodies, bodies[n]) || !leans_on_fixed(bodies, bodies[n], thick_m)) &&
            pad_up(bodies, n, footing_of(bodies, stands, bodies[n]), weights[n], thick_m / 2)) {
            stands.push_back(true);
            continue;
        }
        bodies[n].fixed = bodies[n].held = true;
    }
}

bool put_on_pad(std::vector<Body>& bodies, std::size_t body, double thick_m) {
    const std::vector<bool> all(bodies.size(), true);
    return pad_up(bodies, body, footing_of(bodies, all, bodies[body]), weights_of(bodies)[body],
                  thick_m / 2);
}

}  // namespace topple::exports
