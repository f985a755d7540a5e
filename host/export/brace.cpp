// SPDX-License-Identifier: MIT
#include "export/brace.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "export/footing.h"
#include "export/separate.h"
#include "export/stand.h"
#include "physics/vectors.h"

namespace topple::exports {
namespace {

constexpr std::size_t most_struts = 4;
// Of the height of a body: a longer strut would be a post that nobody would have missed.
constexpr double longest_share = 0.5;
// Of the footing that the parse says a body has: so much is firm enough.
constexpr double firm_share = 0.5;

// An upright bar of a square section, from z up to a point.
std::optional<ConvexPart> bar(const Vec3& to, double z, double half_m) {
    std::vector<Vec3> points;
    for (unsigned c = 0; c < 8; ++c)
        points.push_back({to[0] + ((c & 1) != 0 ? half_m : -half_m),
                          to[1] + ((c & 2) != 0 ? half_m : -half_m), (c & 4) != 0 ? to[2] : z});
    return hull_part(points);
}

struct Strut {
    ConvexPart part;
    double length_m = 0;
};

// A strut under a corner, a little inwards, which meets no other body but with its foot.
std::optional<Strut> strut_under(const std::vector<Body>& bodies, const Body& body,
                                 const ConvexPart& part, const Vec3& corner, double half_m) {
    Vec3 at = corner;
    for (std::size_t a = 0; a < 2; ++a) {
        const double middle = (part.low[a] + part.high[a]) / 2;
        at[a] += std::clamp(middle - corner[a], -half_m, half_m);
    }
    double foot = -physics::infinity;
    for (const Vec3& p :
         {at, Vec3{at[0] - half_m, at[1] - half_m, at[2]},
          Vec3{at[0] + half_m, at[1] - half_m, at[2]}, Vec3{at[0] - half_m, at[1] + half_m, at[2]},
          Vec3{at[0] + half_m, at[1] + half_m, at[2]}})
        foot = std::max(foot, height_below_m(bodies, body, p));
    if (!(foot > -physics::infinity)) return std::nullopt;
    // Into the part, so that it is one with it.
    const Vec3 top{at[0], at[1], at[2] + std::min(half_m, (part.high[2] - at[2]) / 2)};
    auto strut = bar(top, foot, half_m);
    if (!strut) return std::nullopt;
    for (const Body& other : bodies) {
        if (&other == &body) continue;
        for (const ConvexPart& stays : other.parts)
            if (near(*strut, stays, 0) && overlap(*strut, stays)) return std::nullopt;
    }
    return Strut{*std::move(strut), at[2] - foot};
}

std::vector<Strut> struts_of(const std::vector<Body>& bodies, const Body& body, double half_m,
                             double longest_m) {
    std::vector<Strut> out;
    for (const ConvexPart& part : body.parts) {
        for (const Vec3& corner : part.corner) {
            // Of an underside: the part rises from there.
            if (corner[2] > (part.low[2] + part.high[2]) / 2) continue;
            auto strut = strut_under(bodies, body, part, corner, half_m);
            if (strut && strut->length_m <= longest_m) out.push_back(*std::move(strut));
        }
    }
    std::ranges::stable_sort(out, {}, &Strut::length_m);
    return out;
}

std::vector<Point2> with_foot(std::vector<Point2> points, const ConvexPart& strut) {
    for (const Vec3& c : strut.corner)
        if (c[2] < strut.low[2] + 1e-9) points.push_back({c[0], c[1]});
    return points;
}

// Adds struts until the footing is firm: the shortest one that is enough, or the one that helps
// most. Whether the body stands then.
bool add_struts(const std::vector<Body>& bodies, Body& body, double half_m) {
    std::vector<Point2> points = footing_of(bodies, body);
    const double firm = firm_share * body.firm_m;
    double margin = margin_m(points, body);
    if (margin >= firm) return true;
    const ConvexPart box = box_around(body.parts);
    const auto struts = struts_of(bodies, body, half_m, longest_share * (box.high[2] - box.low[2]));
    const auto before = body.parts.size();
    while (margin < firm && body.parts.size() < before + most_struts) {
        const Strut* best = nullptr;
        double best_margin = margin;
        for (const Strut& strut : struts) {
            const double with = margin_m(with_foot(points, strut.part), body);
            if (with <= best_margin + 1e-9 && best) continue;
            if (with < best_margin || (with == best_margin && best)) continue;
            best = &strut;
            best_margin = with;
            if (with >= firm) break;
        }
        if (!best) break;
        points = with_foot(std::move(points), best->part);
        margin = best_margin;
        body.parts.push_back(best->part);
        ++body.struts;
    }
    if (margin > 0) return true;
    body.parts.resize(before);
    body.struts = 0;
    return false;
}

// Whether it touches something fixed beside it.
bool leans_on_fixed(const std::vector<Body>& bodies, const Body& body, double within_m) {
    const ConvexPart box = box_around(body.parts);
    for (const Body& other : bodies) {
        if (!other.fixed) continue;
        for (const ConvexPart& stays : other.parts) {
            if (!near(box, stays, within_m)) continue;
            for (const ConvexPart& part : body.parts)
                if (near(part, stays, within_m) && apart(stays, part).gap_m <= within_m)
                    return true;
        }
    }
    return false;
}

// A slab under the lowest corners of a body.
Body pad_under(const Body& body, double within_m) {
    constexpr double thick_m = 0.01;
    const double lowest = box_around(body.parts).low[2];
    std::vector<Vec3> points;
    for (const ConvexPart& part : body.parts) {
        for (const Vec3& c : part.corner) {
            if (c[2] > lowest + within_m) continue;
            points.push_back({c[0], c[1], lowest});
            points.push_back({c[0], c[1], lowest - thick_m});
        }
    }
    Body pad;
    pad.fixed = true;
    if (auto slab = hull_part(points)) pad.parts.push_back(*std::move(slab));
    return pad;
}

bool clear(const std::vector<Body>& bodies, const Body& body) {
    for (const Body& other : bodies)
        for (const ConvexPart& stays : other.parts)
            for (const ConvexPart& part : body.parts)
                if (near(part, stays, 0) && overlap(part, stays)) return false;
    return true;
}

}  // namespace

void brace(std::vector<Body>& bodies, double thick_m) {
    const std::vector<std::size_t> order = by_level(bodies);
    for (const std::size_t n : order) {
        // Of what falls by itself nothing is held up.
        if (bodies[n].fixed || bodies[n].parts.empty() || !(bodies[n].firm_m > 0)) continue;
        if (add_struts(bodies, bodies[n], thick_m / 2)) continue;
        Body& body = bodies[n];
        if (!leans_on_fixed(bodies, body, thick_m)) {
            Body pad = pad_under(body, thick_m);
            std::vector<Point2> points;
            for (const ConvexPart& part : pad.parts)
                for (const Vec3& c : part.corner) points.push_back({c[0], c[1]});
            if (margin_m(points, body) > 0 && clear(bodies, pad)) {
                body.on_pad = true;
                body.carried_by = {static_cast<std::int32_t>(bodies.size())};
                bodies.push_back(std::move(pad));
                continue;
            }
        }
        body.fixed = body.held = true;
    }
}

}  // namespace topple::exports
