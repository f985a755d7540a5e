// SPDX-License-Identifier: MIT
#include "safety/advise.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "physics/drop.h"
#include "physics/landscape.h"
#include "safety/disturbances.h"

namespace topple {
namespace {

// How far it is moved at most, and how far from there an edge is seen.
constexpr double look_around_m = 1.5, see_edges_m = 0.7;

// Where one object might be moved to.
struct NewPlace {
    std::int32_t di = 0, dj = 0;  // voxels
    double way_m = 0;
    double risk_J = 0;  // of the disturbances whose response tells it
    safety::RiskObject there;
};

struct Mover {
    const SolidScene& solids;
    std::span<const Body> objects;
    std::span<const safety::RiskObject> at_risk;
    std::span<const safety::Disturbance> disturbances;
    double tolerable_J;
    const Unseen& unseen;

    // The nearest places of the object that are tolerable to those: the nearest of each
    // of 16 directions and 12 ranges of distance, by distance.
    std::vector<NewPlace> places(std::size_t o, const Landscape::Places& around) const {
        const Elsewhere elsewhere{toppling_of(objects[o], objects[o].open_tipping),
                                  toppling_of(objects[o], objects[o].level_tipping)};
        std::map<std::pair<int, int>, NewPlace> nearest;
        const std::int32_t half = around.side / 2;
        const double voxel_m = solids.voxel_m();
        const auto stride = static_cast<std::int32_t>(std::lround(around.step_m / voxel_m));
        for (std::int32_t b = 0; b < around.side; ++b) {
            for (std::int32_t a = 0; a < around.side; ++a) {
                NewPlace place;
                place.di = (a - half) * stride;
                place.dj = (b - half) * stride;
                place.way_m = voxel_m * std::hypot(place.di, place.dj);
                if (place.way_m == 0 || place.way_m > look_around_m) continue;
                const std::pair key{
                    static_cast<int>(place.way_m / look_around_m * 12),
                    static_cast<int>(safety::nearest_direction(place.di, place.dj))};
                const auto known = nearest.find(key);
                if (known != nearest.end() && known->second.way_m <= place.way_m) continue;
                const auto slide = physics::slide_elsewhere(
                    around, a, b, at_risk[o].mass_kg, at_risk[o].friction, safety::directions());
                if (!slide.reachable || !weigh(o, slide.slide, elsewhere, place)) continue;
                nearest.insert_or_assign(key, std::move(place));
            }
        }
        std::vector<NewPlace> out;
        for (auto& [key, place] : nearest) out.push_back(std::move(place));
        std::stable_sort(out.begin(), out.end(),
                         [](const NewPlace& a, const NewPlace& b) { return a.way_m < b.way_m; });
        return out;
    }

    // How it topples where no wall is beside it: near an edge of its support, and far from any.
    struct Elsewhere {
        physics::Toppling open, level;
    };
    // Its curve and risk there; false where that is more than is tolerated.
    bool weigh(std::size_t o, const physics::SlideResult& slide, const Elsewhere& elsewhere,
               NewPlace& place) const {
        const Body& object = objects[o];
        physics::Candidate there = object.candidate;
        const double dx = place.di * solids.voxel_m(), dy = place.dj * solids.voxel_m();
        there.body.center[0] += dx;
        there.body.center[1] += dy;
        for (auto& corner : there.support_polygon) corner = {corner[0] + dx, corner[1] + dy};
        const auto drops =
            physics::drops_when_tipped_m(solids.cells(), solids.columns(), there, unseen);
        const bool falls = std::any_of(drops.begin(), drops.end(), [](double d) { return d > 0; });
        // Near an edge the drops are others than here; all that is known is that there are some. So
        // are walls: none is counted on.
        const physics::Instability how =
            physics::combine_curves(falls ? object.open_tipping : object.level_tipping, slide);
        safety::RiskObject changed = at_risk[o];
        changed.barrier_J = how.barrier_J;
        changed.curve = how.curve;
        changed.slide_distance_m = slide.found ? slide.distance_m : -1;
        changed.toppling = std::make_shared<physics::Toppling>(
            (falls ? elsewhere.open : elsewhere.level).elsewhere(slide));
        for (const safety::Disturbance& d : disturbances) {
            if (d.response.empty() || !d.response[o]) continue;
            place.risk_J =
                std::max(place.risk_J, safety::risk_of(d.response[o](changed), changed, 1).mean_J);
        }
        place.there = std::move(changed);
        return place.risk_J <= tolerable_J;
    }
};

// Such a share of the events of a kind that has happened before would have upset it, and yet it
// stood there.
bool fell_before(std::span<const safety::Disturbance> disturbances,
                 std::span<const std::vector<safety::Risk>> risk, std::size_t o, double share) {
    for (std::size_t d = 0; d < disturbances.size(); ++d) {
        const safety::DisturbanceKind* kind = safety::find_disturbance_kind(disturbances[d].name);
        if (kind && kind->everyday && risk[d][o].chance >= share) return true;
    }
    return false;
}

// What holds the object upright against the strongest push of what puts it at more risk than is
// tolerated.
void find_fixing(const safety::RiskObject& object,
                 std::span<const safety::Disturbance> disturbances,
                 std::span<const std::vector<safety::Risk>> risk, std::size_t o, double tolerable_J,
                 Suggestion& out) {
    const double weight = object.mass_kg * physics::gravity, top = std::max(object.height_m, 1e-3);
    out.hold = {0, top};
    for (std::size_t d = 0; d < disturbances.size(); ++d) {
        if (o >= disturbances[d].strongest.size() || risk[d][o].mean_J <= tolerable_J) continue;
        const safety::Push& push = disturbances[d].strongest[o];
        const double tips = (push.force_N * push.height_m - weight * object.base_width_m / 2) / top;
        const double force_N = std::max(tips, push.force_N - object.friction * weight);
        if (!(force_N > out.hold.force_N)) continue;
        out.hold.force_N = force_N;
        out.hold_against = disturbances[d].name;
    }
}

}  // namespace

bool stands_against_odds(const Body& object, std::span<const safety::Disturbance> disturbances,
                         std::span<const std::vector<safety::Risk>> risk, std::size_t o) {
    constexpr double likelier_than_not = 0.5, least_tilt_deg = 3, often = 0.05;  // set by hand
    if (object.grounded) return false;
    return object.rest_probability < likelier_than_not ||
           object.overturning.tilt_deg < least_tilt_deg ||
           fell_before(disturbances, risk, o, often);
}

std::vector<Suggestion> advise(const SolidScene& solids,
                               std::span<const std::int32_t> object_of_primitive,
                               std::span<const Body> objects,
                               std::span<const safety::RiskObject> at_risk,
                               std::span<const safety::Disturbance> disturbances,
                               std::span<const std::vector<safety::Risk>> risk, double tolerable_J,
                               const Unseen& unseen) {
    constexpr double nearly_all = 0.9;
    const SolidCells& cells = solids.cells();
    std::vector<Suggestion> out(at_risk.size());
    std::vector<double> worst(at_risk.size(), 0.0);
    for (const auto& of_disturbance : risk) {
        for (std::size_t o = 0; o < worst.size(); ++o)
            worst[o] = std::max(worst[o], of_disturbance[o].mean_J);
    }
    std::vector<std::size_t> chosen;  // the riskiest first
    std::vector<physics::MassProperties> bodies;
    for (std::size_t o = 0; o < at_risk.size(); ++o) {
        bodies.push_back(objects[o].candidate.body);
        if (objects[o].grounded) continue;
        if (at_risk[o].grounded) out[o].kind = Suggestion::Kind::see;
        if (at_risk[o].grounded || !(worst[o] > tolerable_J)) continue;
        if (at_risk[o].barrier_J <= objects[o].barrier_error_J ||
            fell_before(disturbances, risk, o, nearly_all)) {
            out[o].kind = Suggestion::Kind::check;
            out[o].risk_J = worst[o];
            continue;
        }
        out[o].kind = Suggestion::Kind::fix;
        find_fixing(at_risk[o], disturbances, risk, o, tolerable_J, out[o]);
        chosen.push_back(o);
    }
    std::stable_sort(chosen.begin(), chosen.end(),
                     [&](std::size_t a, std::size_t b) { return worst[a] > worst[b]; });
    if (chosen.size() > most_moved) chosen.resize(most_moved);

    std::vector<double> friction;
    for (const safety::RiskObject& object : at_risk) friction.push_back(object.friction);
    const auto around = physics::places_of(cells, object_of_primitive, bodies, chosen, friction,
                                           look_around_m + see_edges_m, unseen);
    const Mover mover{solids, objects, at_risk, disturbances, tolerable_J, unseen};
    std::vector<safety::Placement> placements;
    std::vector<double> all_J;  // the largest risk there
    for (std::size_t n = 0; n < chosen.size(); ++n) {
        for (NewPlace& place : mover.places(chosen[n], around[n])) {
            all_J.push_back(place.risk_J);
            placements.push_back({chosen[n], place.di, place.dj, std::move(place.there)});
        }
    }
    for (const safety::Disturbance& disturbance : disturbances) {
        if (!disturbance.risk_at) continue;
        const std::vector<safety::Risk> there = disturbance.risk_at(placements);
        for (std::size_t n = 0; n < there.size(); ++n)
            all_J[n] = std::max(all_J[n], there[n].mean_J);
    }
    for (std::size_t n = 0; n < placements.size(); ++n) {
        Suggestion& to = out[placements[n].object];
        if (to.kind == Suggestion::Kind::move) continue;  // nearer ones come first
        if (all_J[n] > tolerable_J) continue;
        to.kind = Suggestion::Kind::move;
        to.move_m = {placements[n].di * cells.voxel_m, placements[n].dj * cells.voxel_m, 0};
        to.risk_J = all_J[n];
        to.hold = {};
        to.hold_against.clear();
    }
    return out;
}

}  // namespace topple
