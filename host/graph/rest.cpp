// SPDX-License-Identifier: MIT
#include "graph/rest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/normal.h"
#include "core/scan_gaps.h"
#include "graph/outline.h"
#include "physics/tipping.h"
#include "solids/cell_shape.h"

namespace topple::graph {
namespace {

using Points = std::vector<std::array<double, 2>>;

// How often a scan misses so much of what holds a thing, of all that stand.
constexpr double often_near = 0.3, often_leaning = 0.1, often_hidden = 0.03;
// How often a scan shows some of a foot, and misses more of it where nobody saw in. On generated
// rooms the tilt of things is the better for it from 0.2 on, and the worse from 0.6 on.
constexpr double often_partly = 0.3;
// How often what is seen to hold a thing holds it above its foot only.
constexpr double often_hung = 0.05;
// What is not seen between a thing and what carries it, of the height that is: with more of it
// nobody knows what its foot is like, or whether it hangs.
constexpr double most_unseen_foot = 0.5;
constexpr std::int32_t uneven_foot = 2;  // voxels
constexpr double least_error_m = 1e-4;   // no border is known better

// A mean of heights.
struct MeanOfHeights {
    double sum = 0, count = 0;
    void add(double height_m) {
        sum += height_m;
        ++count;
    }
    double or_else(double height_m) const { return count > 0 ? sum / count : height_m; }
};

// A column's underside, found once for all ways in which a body may be held.
using Corners = std::vector<solids::UndersideCorner>;

void add_corners(const Corners& corners, std::vector<BorderPoint>& points,
                 MeanOfHeights* height = nullptr) {
    for (const solids::UndersideCorner& c : corners) {
        points.push_back({{c.at[0], c.at[1]}, c.error_m});
        if (height) height->add(c.at[2]);
    }
}

double highest_of(const physics::Candidate& c, const ContactGraph& contacts) {
    double most = -std::numeric_limits<double>::infinity();
    for (const std::int32_t p : c.primitives) most = std::max(most, contacts.highest_m[p]);
    return most;
}

double margin_of(const physics::Candidate& c, const Points& polygon) {
    return physics::footing(polygon, c.body.center[0], c.body.center[1]).margin_m;
}

// How likely a thing is to stand so: little stands near the edge of what holds it, so that a margin
// is as probable as it is wide, up to `widest`; that is what is to be expected of it beyond 0.
double stands(const physics::Candidate& c, const Points& polygon, double noise_m, double widest_m) {
    if (polygon.empty()) return 0;
    const double z = margin_of(c, polygon) / noise_m;
    return std::min(1.0, noise_m * (normal_density(z) + z * normal_cdf(z)) / widest_m);
}

// A polygon whose border is so much farther out.
Points widened(const Points& polygon, double by) {
    constexpr int corners = 16;
    const double radius = by / std::cos(std::numbers::pi / corners);
    Points out;
    for (const auto& [x, y] : polygon) {
        for (int n = 0; n < corners; ++n) {
            const double angle = 2 * std::numbers::pi * n / corners;
            out.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
        }
    }
    return physics::convex_polygon(std::move(out));
}

// A margin measured at z that must be above 0, and little stands within the noise of an edge, so
// that before it is measured its density is m / (m + 2): how far its mean then lies above z, and
// its standard deviation. All in standard errors of the measure.
struct Stood {
    double rise = 0, deviation = 1;
};
Stood given_it_stood(double z) {
    constexpr double step = 0.02, far = 8;
    z = std::max(z, -far);
    double all = 0, first = 0, second = 0;
    for (double m = std::max(z - far, 0.0) + step / 2; m < std::max(z, 0.0) + far; m += step) {
        const double weight = m / (m + 2) * normal_density(m - z);
        all += weight;
        first += weight * m;
        second += weight * m * m;
    }
    const double mean = first / all;
    return {mean - z, std::sqrt(second / all - mean * mean)};
}

// It stood: no measure of its border may say otherwise.
void take_for_standing(const physics::Candidate& c, double noise_m, Rest& rest) {
    constexpr double least = 0.02;  // what is less of the noise is nothing
    const Stood stood = given_it_stood(margin_of(c, rest.support_polygon) / noise_m);
    rest.margin_error_m = noise_m * stood.deviation;
    if (stood.rise > least)
        rest.support_polygon = widened(rest.support_polygon, noise_m * stood.rise);
}

}  // namespace

const char* to_string(RestKind kind) {
    constexpr std::array names{"seen", "near", "leaning", "hidden", "none"};
    return names[static_cast<std::size_t>(kind)];
}

Rest infer_rest(const physics::Candidate& c, const std::vector<Underside>& columns,
                const ContactGraph& contacts, const BoundaryCells& boundary, double center_error_m,
                std::span<const double> floors_m) {
    if (columns.empty()) return {RestKind::none, 1, {}, 0, 0};
    const double h = contacts.voxel_m;
    std::int32_t lowest = std::numeric_limits<std::int32_t>::max();
    for (const Underside& u : columns) lowest = std::min(lowest, u.k);
    std::vector<Corners> corners;
    for (const Underside& u : columns)
        corners.push_back(solids::underside_of(boundary, u.i, u.j, u.k, u.own, h));
    const bool held = !c.support_polygon.empty();

    std::vector<BorderPoint> seen;
    add_points(c.support_polygon, c.border_error_m, seen);
    std::vector<BorderPoint> near = seen, hidden = seen;
    MeanOfHeights foot, met;  // of its lowest columns, and of what they nearly stand on
    std::int32_t lowest_met = std::numeric_limits<std::int32_t>::max();
    for (std::size_t n = 0; n < columns.size(); ++n) {
        const Underside& u = columns[n];
        if (u.gap >= 0 && u.gap <= noise_gap) {
            add_corners(corners[n], near);
            const std::int32_t top = u.k - u.gap - 1;
            if (top < lowest_met) met = {};
            lowest_met = std::min(lowest_met, top);
            if (top == lowest_met) met.add(solids::top_of(boundary, u.i, u.j, top, u.primitive, h));
        }
        if (u.k <= lowest + uneven_foot)
            add_corners(corners[n], hidden, u.k == lowest ? &foot : nullptr);
    }
    const double low_m = foot.or_else(lowest * h);
    double near_height = met.or_else(held ? c.support_height_m : low_m);
    if (held) near_height = std::min(near_height, c.support_height_m);
    const auto hangs_at = [&](double height_m) { return height_m > low_m + noise_gap * h; };
    // What holds it is well above its foot, which is where the room's floor is, and no ray came
    // below that: the floor goes on there.
    const bool at_floor = std::ranges::any_of(
        floors_m, [&](double floor_m) { return std::abs(floor_m - low_m) <= noise_gap * h; });
    if (at_floor && hangs_at(near_height)) {
        std::vector<BorderPoint> on_floor;
        for (std::size_t n = 0; n < columns.size(); ++n)
            if (columns[n].k <= lowest + uneven_foot && columns[n].gap < 0)
                add_corners(corners[n], on_floor);
        if (!on_floor.empty()) {
            near = std::move(on_floor);
            near_height = low_m;
        }
    }
    // The foot that was seen may go on where nobody saw in, down to what carries it.
    std::vector<BorderPoint> partly = near;
    bool goes_on = false;
    for (std::size_t n = 0; n < columns.size(); ++n) {
        const Underside& u = columns[n];
        if (!held || u.unseen == 0 || u.k * h - near_height > (u.unseen + noise_gap) * h) continue;
        add_corners(corners[n], partly);
        goes_on = true;
    }
    std::vector<BorderPoint> leaning = near;
    for (const std::int32_t p : c.primitives) {
        for (const Leaning& l : contacts.leanings_of(p)) {
            if (!std::binary_search(c.primitives.begin(), c.primitives.end(), l.against))
                add_points({l.outline.begin(), l.outline.end()}, solids::voxel_error * h, leaning);
        }
    }
    std::vector<BorderPoint> all_columns;
    for (const Corners& of_column : corners) add_corners(of_column, all_columns);
    Outline whole = outline_of(all_columns);
    const double widest = margin_of(c, whole.polygon);
    struct Way {
        RestKind kind;
        std::vector<BorderPoint> points;
        double height, often;
    };
    const bool hung = held && hangs_at(c.support_height_m);
    std::array<Way, 4> ways{
        Way{RestKind::seen, std::move(seen), c.support_height_m, hung ? often_hung : 1},
        Way{RestKind::near, std::move(near), near_height, often_near},
        Way{RestKind::leaning, std::move(leaning), near_height, often_leaning},
        Way{RestKind::hidden, std::move(hidden), low_m, often_hidden}};
    Rest best;
    double most = -1, sum = 0, noise_m = 0;
    const auto weigh = [&](RestKind kind, Outline outline, double at_m, double often) {
        const double noise = std::hypot(std::max(outline.error_m, least_error_m), center_error_m);
        const double chance = often * stands(c, outline.polygon, noise, std::max(widest, noise));
        sum += chance;
        if (chance <= most) return;
        most = chance;
        noise_m = noise;
        best = {kind, 0, std::move(outline.polygon), at_m, 0};
    };
    for (const Way& way : ways)
        if (!way.points.empty()) weigh(way.kind, outline_of(way.points), way.height, way.often);
    // Even its foot is too small: all that is above may rest on something.
    weigh(RestKind::hidden, std::move(whole), low_m, 0.3 * often_hidden);
    double unseen_margin_m = 0;
    if (goes_on) {
        Outline more = outline_of(partly);
        unseen_margin_m = margin_of(c, more.polygon);
        weigh(RestKind::near, std::move(more), near_height, often_partly);
    }
    best.probability = sum > 0 ? most / sum : 1;
    const double unseen_m = low_m - best.support_height_m;
    if (unseen_m > noise_gap * h && unseen_m > most_unseen_foot * (highest_of(c, contacts) - low_m))
        best.kind = RestKind::hidden;
    take_for_standing(c, noise_m, best);
    if (unseen_margin_m > margin_of(c, best.support_polygon) + noise_m)
        best.unseen_margin_m = unseen_margin_m;
    return best;
}

}  // namespace topple::graph
