// SPDX-License-Identifier: MIT
#include "safety/safety_stage.h"

#include <algorithm>
#include <cmath>

#include "objects/legs.h"
#include "physics/overturning.h"
#include "physics/tipping.h"
#include "safety/disturbances.h"
#include "safety/find_fastenings.h"
#include "safety/risk_error.h"
#include "safety/wind/wind_field.h"

namespace topple {
namespace {

// Whether as much of a ceiling was scanned as half of the floor: pieces of one are lintels, too.
bool is_below_ceiling(const SolidScene& solids) {
    std::size_t floor = 0, ceiling = 0;
    for (const std::int32_t p : solids.cells().primitive) {
        if (p < 0) continue;
        floor += solids.role(p) == Role::floor;
        ceiling += solids.role(p) == Role::ceiling;
    }
    return ceiling > 0 && 2 * ceiling >= floor;
}

}  // namespace

safety::Surroundings surroundings_of(const SolidScene& solids, ObjectOf object_of,
                                     TableView<PrimitiveId, physics::MassProperties> bodies) {
    safety::Surroundings s;
    s.cells = &solids.cells();
    for (const std::int32_t p : solids.cells().primitive) s.object.push_back(object_of(p));
    for (std::size_t p = 0; p < solids.primitives(); ++p)
        s.is_floor_primitive.push_back(solids.role(static_cast<std::int32_t>(p)) == Role::floor);
    s.below_ceiling = is_below_ceiling(solids);
    for (const physics::MassProperties& b : bodies) s.density_kg_m3.push_back(b.density_kg_m3());
    return s;
}

std::vector<safety::RiskObject> risk_objects(std::span<const Body> objects) {
    std::vector<safety::RiskObject> out;
    for (const Body& o : objects) {
        safety::RiskObject r;
        // What is held by nothing that was seen is held by what was not: nobody knows how firmly.
        r.grounded = o.grounded || !o.seen_enough() || o.candidate.support_polygon.empty();
        r.mass_kg = o.candidate.body.mass_kg;
        r.barrier_J = o.instability.barrier_J;
        r.barrier_error_J = o.seen_error_J;
        r.floor_shakes = o.floor_shakes;
        r.drawers = o.drawers;
        r.friction = o.friction.coefficient;
        r.friction_error_share = o.friction.error_share();
        r.slides = o.instability.mode == physics::Instability::Mode::slide;
        r.base_m = o.candidate.support_height_m;
        r.center = o.candidate.body.center;
        r.height_m = o.box.top_m() - r.base_m;
        r.base_width_m = physics::least_width_m(o.candidate.support_polygon);
        r.base_error_share = physics::slope_error_share(o.overturning);
        if (o.sliding.found) r.slide_distance_m = o.sliding.distance_m;
        r.curve = o.instability.curve;
        r.toppling = o.toppling;
        r.support_polygon = o.candidate.support_polygon;
        out.push_back(std::move(r));
    }
    return out;
}

namespace {

// Risks, and what the errors of barriers and masses make of them and of the categories.
void weigh_risks(std::span<const double> mass_error_kg, std::span<const safety::RiskObject> at_risk,
                 SafetyStage& out) {
    const auto weaker = safety::at_end(at_risk, -1), firmer = safety::at_end(at_risk, 1);
    out.category.resize(at_risk.size());
    for (safety::Disturbance& d : out.disturbances) {
        out.risk.push_back(safety::risk(d, at_risk));
        const auto lower = safety::risk_if(d, weaker), higher = safety::risk_if(d, firmer);
        std::vector<double> error_J;
        for (std::size_t o = 0; o < at_risk.size(); ++o) {
            const double mass_kg = at_risk[o].mass_kg;
            const double share = mass_kg > 0 ? mass_error_kg[o] / mass_kg : 0;
            error_J.push_back(
                safety::risk_error_J(out.risk.back()[o], {lower[o], higher[o]}, share));
            safety::CategoryEnds& ends = out.category[o];
            ends.lower = std::max(ends.lower, safety::category(lower[o], 1 + share));
            ends.measured = std::max(ends.measured, safety::category(out.risk.back()[o], 1));
            ends.higher =
                std::max(ends.higher, safety::category(higher[o], std::max(0.0, 1 - share)));
        }
        out.risk_error_J.push_back(std::move(error_J));
    }
}

// Parts what was found of those that may be things from what was of objects.
void part_possible(std::size_t objects, SafetyStage& out) {
    const auto part = [&](auto& all) {
        auto of_possible = all;
        of_possible.erase(of_possible.begin(),
                          of_possible.begin() + static_cast<std::ptrdiff_t>(objects));
        all.resize(objects);
        return of_possible;
    };
    for (std::vector<safety::Risk>& risk : out.risk) out.possible_risk.push_back(part(risk));
    for (std::vector<double>& error : out.risk_error_J) error.resize(objects);
    out.possible_category = part(out.category);
}

// What categories objects would have if they were what they may be else: as exposed as they are, as
// if all of it stood where they do.
void weigh_alternatives(std::span<const OtherReading> alternatives,
                        std::span<const safety::RiskObject> at_risk, SafetyStage& out) {
    out.if_otherwise.resize(alternatives.size());
    std::vector<bool> weighed(alternatives.size());
    for (std::size_t left = alternatives.size(); left > 0;) {
        // One of each object at a time.
        std::vector<safety::RiskObject> changed(at_risk.begin(), at_risk.end());
        std::vector<std::size_t> which;
        ObjectId last;
        for (std::size_t n = 0; n < alternatives.size(); ++n) {
            const OtherReading& reading = alternatives[n];
            if (weighed[n] || reading.object == last) continue;
            last = reading.object;
            weighed[n] = true;
            which.push_back(n);
            changed[reading.object.place()] = risk_objects({&reading.body, 1}).front();
        }
        left -= which.size();
        for (const safety::Disturbance& d : out.disturbances) {
            const std::vector<safety::Risk> risks = safety::risk_if(d, changed);
            for (const std::size_t n : which) {
                const safety::Risk& risk = risks[alternatives[n].object.place()];
                out.if_otherwise[n] = std::max(out.if_otherwise[n], safety::category(risk, 1));
            }
        }
    }
}

}  // namespace

SafetyStage assess_safety(device::Device& device, const SolidParts& parts,
                          const ObjectStage& objects, const ParseOptions& options,
                          StageClock& stage) {
    SafetyStage out;
    std::vector<safety::RiskObject> all = risk_objects(objects.objects);
    std::vector<double> mass_error_kg;
    for (const Body& o : objects.objects) mass_error_kg.push_back(o.mass_error_kg());
    for (const PossibleBody& thing : objects.possible_things) {
        all.push_back(risk_objects({&thing.body, 1}).front());
        mass_error_kg.push_back(thing.body.mass_error_kg());
    }
    // `all` goes on with what may be a thing.
    const std::span<const safety::RiskObject> at_risk(all.data(), objects.objects.size());
    const safety::Surroundings around =
        surroundings_of(*parts.solids, objects.body_of_primitive, objects.bodies);
    out.below_ceiling = around.below_ceiling;
    for (const safety::DisturbanceKind* kind : safety::acting_kinds(options)) {
        out.disturbances.push_back(stage(std::string("field ") + kind->name, [&] {
            return kind->field(device, around, all, options);
        }));
    }
    stage("falls", [&] {
        out.landings = landings(parts, objects);
        std::vector<safety::FallZone> zones;
        for (const Landing& landing : out.landings) zones.push_back(landing.zone);
        for (const safety::Disturbance& disturbance : out.disturbances)
            if (disturbance.passing_shares) out.people_share = disturbance.passing_shares(zones);
    });
    out.gust_m_s = stage("gusts", [&] {
        for (const safety::Disturbance& disturbance : out.disturbances)
            if (!disturbance.gust_m_s.empty()) return disturbance.gust_m_s;
        return safety::tipping_gusts(device, around, all, {});
    });
    stage("risk", [&] {
        weigh_risks(mass_error_kg, all, out);
        part_possible(at_risk.size(), out);
        out.unsafety = safety::unsafety(out.risk);
        out.unsafety.resize(at_risk.size(), 1.0);
        weigh_alternatives(objects.alternatives, all, out);
    });
    stage("advice", [&] {
        out.advice = advise(*parts.solids, objects.object_of_primitive, objects.objects, at_risk,
                            out.disturbances, out.risk, options.tolerable_J, unseen_of(parts));
        const std::vector<Fastening> fastenings = find_fastenings(parts, objects);
        const std::vector<std::int32_t> legs =
            find_legs(*parts.solids, objects.object_of_primitive, objects.objects);
        for (std::size_t o = 0; o < out.advice.size(); ++o) {
            out.advice[o].fasten = fastenings[o];
            out.advice[o].leg_of = legs[o];
        }
    });
    for (safety::Disturbance& disturbance : out.disturbances) {
        disturbance.work_if = {};
        disturbance.risk_at = {};
        disturbance.passing_shares = {};
    }
    return out;
}

}  // namespace topple
