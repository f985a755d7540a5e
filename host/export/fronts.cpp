// SPDX-License-Identifier: MIT
#include "export/fronts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/vectors.h"

namespace topple::exports {
namespace {

// Edges of fronts are looked for at steps of a centimetre.
constexpr double edge_step_m = 0.01;

// Few drawers are higher.
constexpr double high_drawer_m = 0.45;

// By opening: slide, hinge at low u, hinge at high u.
using Chances = std::array<double, 3>;

// high_m: of the face.
Chances prior_of(const std::vector<Grip>& grips, double high_m) {
    // Doors one over the other are rare, drawers are not; and few of these are higher than that.
    constexpr double high_share = 0.05;
    switch (grips.front().form) {
        case Grip::Form::upright_bar:
            return {0.02, 0.49, 0.49};
        case Grip::Form::level_bar:
            return {0.9, 0.05, 0.05};
        default:
            if (grips.size() > 1) return {0.96, 0.02, 0.02};
            if (high_m > high_drawer_m)
                return {high_share, (1 - high_share) / 2, (1 - high_share) / 2};
            return {0.6, 0.2, 0.2};
    }
}

double middle_u(const std::vector<Grip>& grips) {
    double sum = 0;
    for (const Grip& grip : grips) sum += grip.u;
    return sum / static_cast<double>(grips.size());
}

// How likely fronts that have an edge at `low` and one at `high` have their grips at u.
class ColumnChances {
  public:
    ColumnChances(const std::vector<Grip>& grips, double high_m)
        : u_(middle_u(grips)), prior_(prior_of(grips, high_m)) {}

    Chances at(double low, double high) const {
        constexpr double from_edge_m = 0.05;
        if (low > u_ - edge_step_m || high < u_ + edge_step_m) return {};
        const double width = usual_width(high - low);
        return {prior_[0] * width * near(u_ - (low + high) / 2),
                prior_[1] * width * near(high - u_ - from_edge_m),
                prior_[2] * width * near(u_ - low - from_edge_m)};
    }
    double sum_at(double low, double high) const {
        const Chances each = at(low, high);
        return each[0] + each[1] + each[2];
    }

  private:
    static double near(double off_m) {
        constexpr double sigma_m = 0.015, floor = 1e-9;
        return std::exp(-off_m * off_m / (2 * sigma_m * sigma_m)) + floor;
    }
    static double usual_width(double wide_m) {
        constexpr double mean_m = 0.5, sigma_m = 0.2;
        const double off = (wide_m - mean_m) / sigma_m;
        return std::exp(-off * off / 2);
    }

    double u_;
    Chances prior_;
};

std::vector<std::vector<Grip>> grip_columns(const std::vector<Grip>& by_u) {
    constexpr double one_column_m = 0.04;
    std::vector<std::vector<Grip>> out;
    for (const Grip& grip : by_u) {
        if (out.empty() || grip.u - middle_u(out.back()) > one_column_m) out.emplace_back();
        out.back().push_back(grip);
    }
    for (auto& column : out) std::ranges::stable_sort(column, {}, &Grip::z);
    return out;
}

// Heights that part the fronts of a column of drawers: each has its grip at the same share of its
// height, as far as the lowest and the highest one tell.
std::vector<double> drawer_edges(const std::vector<Grip>& grips, double low, double high) {
    const double below = grips.front().z - low, above = high - grips.back().z;
    const double share = std::clamp(below / std::max(below + above, edge_step_m), 0.2, 0.8);
    std::vector<double> out{low};
    for (std::size_t n = 1; n < grips.size(); ++n)
        out.push_back(grips[n - 1].z + (1 - share) * (grips[n].z - grips[n - 1].z));
    out.push_back(high);
    return out;
}

// The same of doors over one another: midway between their grips.
std::vector<double> door_edges(const std::vector<Grip>& grips, double low, double high) {
    std::vector<double> out{low};
    for (std::size_t n = 1; n < grips.size(); ++n)
        out.push_back(
            (grips[n - 1].z + grips[n - 1].high_m / 2 + grips[n].z - grips[n].high_m / 2) / 2);
    out.push_back(high);
    return out;
}

// What looks like a front is none more often than grips and their places tell. Chosen so that nine
// of ten that are made are right: 35 of 36 in 42 generated rooms in which nothing else was fitted,
// where without it 41 of 49 are.
double by_experience(double probability) {
    constexpr double odds_share = 0.25;
    return odds_share * probability / (odds_share * probability + 1 - probability);
}

// Flaps, as of ovens and dishwashers: high ones with a wide bar along the upper edge.
bool opens_below(const Grip& grip, double wide_m, double low, double high) {
    constexpr double least_high_m = 0.4, least_share = 0.75, least_wide = 0.5;
    return grip.form == Grip::Form::level_bar && high - low >= least_high_m &&
           grip.z - low >= least_share * (high - low) && grip.wide_m >= least_wide * wide_m;
}

void add_fronts(const GrippedFace& face, const ColumnFronts& column, std::vector<Front>& out) {
    constexpr double least_wide_m = 0.15, least_high_m = 0.08;
    const Chances chances{column.slide, column.hinge_at_low_u, column.hinge_at_high_u};
    const auto likeliest = std::ranges::max_element(chances) - chances.begin();
    const double wide_m = column.high_u - column.low_u;
    const std::vector<double> edges = likeliest == 0
                                          ? drawer_edges(column.grips, face.low_z, face.high_z)
                                          : door_edges(column.grips, face.low_z, face.high_z);
    for (std::size_t n = 0; n < column.grips.size(); ++n) {
        const Grip& grip = column.grips[n];
        const double low = edges[n], high = edges[n + 1];
        if (wide_m < least_wide_m || high - low < least_high_m) continue;
        Front front;
        front.opening = static_cast<Opening>(likeliest);
        if (likeliest == 0 && column.grips.size() == 1 && opens_below(grip, wide_m, low, high))
            front.opening = Opening::hinge_below;
        front.high_m = high - low;
        front.probability = chances[likeliest] * grip.probability;
        // Of a column of drawers one grip alone may have been seen.
        if (front.opening == Opening::slide && column.grips.size() == 1 &&
            front.high_m > high_drawer_m)
            front.probability *= 0.5;
        front.probability = by_experience(front.probability);
        front.out = face.out;
        front.across = face.across;
        front.colour = face.colour;
        front.wide_m = wide_m;
        front.middle = face.place((column.low_u + column.high_u) / 2, (low + high) / 2);
        front.grip = face.place(grip.u, grip.z, grip.out_m / 2);
        front.grip_m = {grip.wide_m, grip.out_m, grip.high_m};
        front.deep_m = face.deep_m;
        if (front.probability > 0.5) out.push_back(front);
    }
}

// So that the largest is 1: products over many columns would get lost. False where none is above 0.
bool scaled_to_one(std::vector<double>& values) {
    const double most = *std::ranges::max_element(values);
    if (!(most > 0)) return false;
    for (double& each : values) each /= most;
    return true;
}

// Faces that lie close behind one another may have the same grip: the larger front has it.
void drop_doubles(std::vector<std::vector<Front>>& of_object) {
    constexpr double one_grip_m = 0.05;
    struct Place {
        std::size_t object, at;
    };
    std::vector<Place> order;
    for (std::size_t o = 0; o < of_object.size(); ++o)
        for (std::size_t n = 0; n < of_object[o].size(); ++n) order.push_back({o, n});
    const auto front = [&](const Place& p) -> const Front& { return of_object[p.object][p.at]; };
    std::ranges::stable_sort(order, std::ranges::greater{},
                             [&](const Place& p) { return front(p).wide_m * front(p).high_m; });
    std::vector<std::vector<Front>> out(of_object.size());
    std::vector<Vec3> grips;
    for (const Place& p : order) {
        if (std::ranges::any_of(grips, [&](const Vec3& grip) {
                return length(minus(grip, front(p).grip)) < one_grip_m;
            }))
            continue;
        grips.push_back(front(p).grip);
        out[p.object].push_back(front(p));
    }
    of_object = std::move(out);
}

}  // namespace

std::vector<ColumnFronts> columns_of(const GrippedFace& face) {
    // That a part of a face has no grip, or none that was seen.
    constexpr double gap_chance = 0.02;
    const std::vector<std::vector<Grip>> grips = grip_columns(face.grips);
    const std::size_t steps =
        static_cast<std::size_t>(std::lround(face.wide_m() / edge_step_m)) + 1;
    const auto edge = [&](std::size_t n) {
        return face.low_u + static_cast<double>(n) * edge_step_m;
    };
    const double gap = gap_chance / static_cast<double>(steps);
    // Forward and backward over the columns (Rabiner, "A tutorial on hidden Markov models", 1989):
    // `from`: how likely all before is where a column begins at an edge; `to`: all behind where it
    // ends there.
    std::vector<ColumnChances> chances;
    for (const auto& column : grips) chances.emplace_back(column, face.high_m());
    std::vector<std::vector<double>> from(grips.size()), to(grips.size());
    std::vector<double> ends(steps, 0);
    ends[0] = 1;
    for (std::size_t c = 0; c < grips.size(); ++c) {
        double before = 0;
        for (std::size_t n = 0; n < steps; ++n) {
            from[c].push_back(ends[n] + gap * before);
            before += ends[n];
        }
        std::ranges::fill(ends, 0.0);
        for (std::size_t a = 0; a < steps; ++a)
            for (std::size_t b = a + 1; b < steps; ++b)
                ends[b] += from[c][a] * chances[c].sum_at(edge(a), edge(b));
        if (!scaled_to_one(ends)) return {};
    }
    std::vector<double> begins(steps, 0);
    begins[steps - 1] = 1;
    for (std::size_t c = grips.size(); c-- > 0;) {
        double behind = 0;
        to[c].assign(steps, 0);
        for (std::size_t n = steps; n-- > 0;) {
            to[c][n] = begins[n] + gap * behind;
            behind += begins[n];
        }
        std::ranges::fill(begins, 0.0);
        for (std::size_t a = 0; a < steps; ++a)
            for (std::size_t b = a + 1; b < steps; ++b)
                begins[a] += to[c][b] * chances[c].sum_at(edge(a), edge(b));
        if (!scaled_to_one(begins)) return {};
    }
    std::vector<ColumnFronts> out;
    for (std::size_t c = 0; c < grips.size(); ++c) {
        Chances sum{}, most{};
        std::array<std::pair<double, double>, 3> edges{};
        for (std::size_t a = 0; a < steps; ++a) {
            for (std::size_t b = a + 1; b < steps; ++b) {
                const Chances each = chances[c].at(edge(a), edge(b));
                for (std::size_t t = 0; t < each.size(); ++t) {
                    const double here = from[c][a] * each[t] * to[c][b];
                    sum[t] += here;
                    if (here <= most[t]) continue;
                    most[t] = here;
                    edges[t] = {edge(a), edge(b)};
                }
            }
        }
        const double all = sum[0] + sum[1] + sum[2];
        if (!(all > 0)) return {};
        const auto likeliest = std::ranges::max_element(sum) - sum.begin();
        out.push_back({sum[0] / all, sum[1] / all, sum[2] / all, edges[likeliest].first,
                       edges[likeliest].second, grips[c]});
    }
    return out;
}

std::vector<std::vector<Front>> fronts_of(const Scene& scene) {
    const std::vector<std::vector<GrippedFace>> faces = gripped_faces(scene);
    std::vector<std::vector<Front>> out(faces.size());
    for (std::size_t o = 0; o < faces.size(); ++o)
        for (const GrippedFace& face : faces[o])
            for (const ColumnFronts& column : columns_of(face)) add_fronts(face, column, out[o]);
    drop_doubles(out);
    return out;
}

}  // namespace topple::exports
