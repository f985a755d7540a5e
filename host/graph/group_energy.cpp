// SPDX-License-Identifier: MIT
#include "graph/group_energy.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "physics/drop.h"
#include "physics/tipping.h"

namespace topple::graph {
namespace {

// S(O, W) of Eq. 6 at the energy W: the largest release that W sets free.
double release_at(const physics::Stability& stability, double work_J) {
    double release = 0;
    for (const InstabilityStep& step : stability.curve) {
        if (step.W_J <= work_J) release = std::max(release, step.S_J);
    }
    return release;
}

// Whether a body withstands a tilt of its support: S = 0 without a look at its landscape. The
// height that tilting by an angle a lifts the centre of mass by is h (1 / cos a - 1), and an edge
// at the distance m asks for sqrt(h^2 + m^2) - h: the one is less than the other where m > h tan a.
// slack_m: what the outline of the support, made of whole voxels, is too wide by.
bool stands(const physics::Candidate& c, double tilt, double slack_m) {
    if (c.support_polygon.empty()) return false;
    const physics::Footing foot =
        physics::footing(c.support_polygon, c.body.center[0], c.body.center[1]);
    const double height = c.body.center[2] - c.support_height_m;
    return foot.margin_m > slack_m && foot.margin_m - slack_m >= height * std::tan(tilt);
}

}  // namespace

GroupEnergy::GroupEnergy(device::Device& device, const physics::SupportTable& table,
                         const SolidCells& cells, const ContactGraph& graph,
                         std::span<const physics::Body> bodies, const SurfaceSeams& seams,
                         const std::vector<bool>& ground, const GroupingOptions& options)
    : device_(device),
      table_(table),
      cells_(cells),
      graph_(graph),
      bodies_(bodies),
      ground_(ground),
      options_(options),
      prior_(graph, bodies, seams, ground, options.prior),
      columns_(cells),
      tilt_(options.tilt_deg * std::numbers::pi / 180) {}

// The body that a query asks about, if it does not stand.
std::optional<physics::Candidate> GroupEnergy::unstable_body(const GroupQuery& query) const {
    if (query.pinned) return std::nullopt;  // the ground does not fall: S = 0
    physics::Candidate c = candidate_of(graph_, bodies_, ground_, query.nodes);
    if (c.body.mass_kg <= 0 || stands(c, tilt_, 0.5 * cells_.voxel_m)) return std::nullopt;
    return c;
}

double GroupEnergy::fall_m(const physics::Candidate& body) const {
    // What hangs in the air at rest is held by something, however short its fall would be.
    return body.support_polygon.empty()
               ? std::max(free_fall_m(graph_, body.primitives), options_.scale_m)
               : physics::drop_when_tipped_m(cells_, columns_, body);
}

double GroupEnergy::instability(double released_m) const {
    return std::min(options_.worst_instability, released_m / options_.scale_m);
}

void GroupEnergy::operator()(std::span<const GroupQuery> queries,
                             std::span<double> energies) const {
    std::vector<physics::Candidate> unstable;
    std::vector<std::size_t> query;  // of each candidate
    for (std::size_t i = 0; i < queries.size(); ++i) {
        energies[i] = prior_(queries[i].nodes);
        std::optional<physics::Candidate> c = unstable_body(queries[i]);
        if (!c) continue;
        if (c->support_polygon.empty()) {  // it falls as it is
            energies[i] += instability(fall_m(*c));
            continue;
        }
        unstable.push_back(*std::move(c));
        query.push_back(i);
    }
    const std::vector<physics::Stability> stability = physics::evaluate(device_, table_, unstable);
    for (std::size_t n = 0; n < unstable.size(); ++n) {
        const physics::Candidate& c = unstable[n];
        const double weight = c.body.mass_kg * physics::gravity;
        const double height = std::max(c.body.center[2] - c.support_height_m, 0.0);
        // What does not stand by stands() falls, whatever its barrier.
        const double release =
            std::max(release_at(stability[n], weight * height * (1 / std::cos(tilt_) - 1)),
                     stability[n].release_J);
        energies[query[n]] += instability(release / weight + fall_m(c));
    }
}

GroupEnergies GroupEnergy::callbacks() const {
    // Instability is never below 0, nor below what the fall alone makes.
    const auto prior_alone = [this](const GroupQuery& query, double) {
        return prior_(query.nodes);
    };
    const auto prior_and_fall = [this](const GroupQuery& query, double prior_of_it) {
        const std::optional<physics::Candidate> c = unstable_body(query);
        return c ? prior_of_it + instability(fall_m(*c)) : prior_of_it;
    };
    const auto energy = [this](std::span<const GroupQuery> queries, std::span<double> energies) {
        (*this)(queries, energies);
    };
    return {energy, {prior_alone, prior_and_fall}};
}

}  // namespace topple::graph
