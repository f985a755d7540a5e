// SPDX-License-Identifier: MIT
#include "result/assemble.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "io/text.h"
#include "objects/told_sentences.h"
#include "physics/directions.h"
#include "physics/overturning.h"
#include "result/explanations.h"
#include "result/possible_things.h"
#include "result/sentences.h"
#include "safety/disturbances.h"
#include "safety/earthquake/fragility.h"
#include "topple/version.h"

namespace topple {
namespace {

void add_primitives(const SolidParts& parts, const ObjectStage& objects, const ToInput& to_input,
                    Scene& scene) {
    for (std::size_t p = 0; p < objects.bodies.size(); ++p) {
        const physics::MassProperties& body = objects.bodies[p];
        Primitive out;
        out.id = static_cast<std::int32_t>(p);
        out.object = objects.object_of_primitive[p];
        out.model = parts.model[p];
        out.points = parts.points[p];
        out.solid_voxels = body.voxels;
        out.volume_m3 = body.volume_m3;
        out.mass_kg = body.mass_kg;
        out.center_of_mass_m = to_input.place(body.center);
        const auto name = objects.told.name_of_part.find(out.id);
        if (name != objects.told.name_of_part.end()) out.name = name->second;
        scene.primitives.push_back(std::move(out));
    }
}

Landscape turned(const Body& from, const ToInput& to_input) {
    Landscape out = from.poses;
    out.places = from.sliding.places;
    for (Vec3& corner : out.hull_m) corner = to_input.place(corner);
    for (Landscape::Pose& pose : out.poses) pose.up = to_input.way(pose.up);
    for (Landscape::Pass& pass : out.passes) {
        pass.up = to_input.way(pass.up);
        for (Vec3& up : pass.border) up = to_input.way(up);
    }
    return out;
}

// By azimuth, which is clockwise from north, +y of the grid.
DirectedBarrier directed(const Body& from, const ToInput& to_input) {
    const physics::Toppling& toppling = *from.toppling;
    static_assert(DirectedBarrier::directions == safety::direction_count);
    DirectedBarrier out;
    for (std::size_t h = 0; h < physics::Toppling::heights; ++h)
        out.height_m.push_back(toppling.height_m(h));
    for (unsigned n = 0; n < safety::direction_count; ++n) {
        const auto [x, y] = safety::direction(
            (safety::direction_count + safety::direction_count / 4 - n) % safety::direction_count);
        const Vec3 way{x, y, 0};
        out.push_J.push_back(toppling.push_barrier_J(way));
        for (const double height : out.height_m) {
            out.blow_J.push_back(toppling.blow_barrier_J(way, height));
            out.blow_Ns.push_back(toppling.impulse_Ns(out.blow_J.back(), way, height));
        }
        out.direction.push_back(to_input.way(way));
        if (std::isnan(from.overturning.hand_height_m)) continue;  // it hangs
        const physics::Toppling::EdgeAhead edge = toppling.edge_ahead(way);
        const physics::TippingPush push =
            physics::tipping_push(from.candidate.body, from.body_error, edge.distance_m,
                                  edge.cosine, from.margin_error_m, from.overturning.hand_height_m);
        out.push_N.push_back(push.push_N);
        out.push_error_N.push_back(push.error_N);
    }
    return out;
}

void add_objects(const ObjectStage& objects, const SafetyStage& safety, const ToInput& to_input,
                 Scene& scene) {
    for (std::size_t o = 0; o < objects.objects.size(); ++o) {
        const Body& from = objects.objects[o];
        Object to;
        to.id = static_cast<std::int32_t>(o);
        to.primitives = from.candidate.primitives;
        to.grounded = from.grounded;
        to.agreement = from.agreement;
        to.mass_kg = from.candidate.body.mass_kg;
        to.size_m = from.box.size_m;
        to.box_middle_m = to_input.place(from.box.middle_m);
        to.piece_probability = from.piece.probability;
        if (from.piece.probability > 0.5)
            to.piece_of = objects.object_of_primitive[from.piece.primitive];
        to.joint_probability = from.weakest.probability;
        to.weakest_joint = {from.weakest.a, from.weakest.b};
        to.mass_model = to_string(from.mass_model);
        if (from.friction.coefficient != scene.friction) to.friction = from.friction.coefficient;
        to.center_of_mass_m = to_input.place(from.candidate.body.center);
        to.inertia_kg_m2 = to_input.tensor(from.inertia);
        to.mass_error_kg = from.mass_error_kg();
        to.center_of_mass_error_m = to_input.errors(from.body_error.center_m);
        if (!from.grounded) {
            to.barrier_J = from.instability.barrier_J;
            to.footprint_error_m = from.margin_error_m;
            to.barrier_error_J = from.barrier_error_J;
            to.release_J = from.instability.release_J;
            if (from.seen_enough()) {
                to.support_height_m = to_input.height(from.candidate.support_height_m);
                to.center_height_m =
                    from.candidate.body.center[2] - from.candidate.support_height_m;
                to.overturning = from.overturning;
            }
            to.overturning.direction = to_input.way(to.overturning.direction);
            if (from.seen_enough()) {
                // Its force is the push times what its area is to its top's height: errors are as
                // those of the push, and halved by the root.
                to.overturning.gust_m_s = safety.gust_m_s[o];
                to.overturning.gust_error_m_s = to.overturning.gust_m_s *
                                                to.overturning.push_error_N /
                                                to.overturning.push_N / 2;
            }
            to.mode = physics::to_string(from.instability.mode);
            to.direction = to_input.way(from.instability.direction);
            to.instability = from.instability.curve;
            if (from.seen_enough() && from.toppling)
                to.barrier_by_direction = directed(from, to_input);
            to.landscape = turned(from, to_input);
        }
        for (std::size_t d = 0; d < safety.disturbances.size(); ++d) {
            const std::string& name = safety.disturbances[d].name;
            const safety::Risk& risk = safety.risk[d][o];
            to.risk_J[name] = risk.mean_J;
            to.risk_spread_J[name] = risk.spread_J;
            to.risk_error_J[name] = safety.risk_error_J[d][o];
            to.fall_chance[name] = risk.chance;
            if (o < safety.disturbances[d].fragility.size())
                to.fragility = safety.disturbances[d].fragility[o];
            if (o < safety.disturbances[d].holds.size())
                for (Hold hold : safety.disturbances[d].holds[o]) {
                    hold.place_m = to_input.place(hold.place_m);
                    hold.force_N = to_input.way(hold.force_N);
                    hold.impulse_Ns = to_input.way(hold.impulse_Ns);
                    to.holds.push_back(std::move(hold));
                }
        }
        to.seen_enough = from.grounded || from.seen_enough();
        to.rests_by = from.grounded ? "ground" : graph::to_string(from.rest);
        to.rest_probability = from.rest_probability;
        // Without a disturbance nothing is known of what may fall, and nothing is safe.
        const bool ranked = from.grounded || (to.seen_enough && !safety.disturbances.empty());
        to.unsafety = from.grounded ? 1
                      : ranked      ? safety.unsafety[o]
                                    : std::numeric_limits<double>::quiet_NaN();
        const safety::CategoryEnds& category = safety.category[o];
        to.unsafety_category = ranked ? safety::to_string(category.worst()) : "";
        to.unsafety_certain = ranked && category.certain() && to.piece_of < 0 &&
                              !from.weakest.doubtful() &&
                              safety.advice[o].kind != Suggestion::Kind::check &&
                              !stands_against_odds(from, safety.disturbances, safety.risk, o);
        to.name = objects.told.name[o];
        to.corrected = objects.told.corrected[o];
        scene.objects.push_back(std::move(to));
    }
}

// What objects may be else: those of another category are not certain of theirs.
void add_alternatives(const ObjectStage& objects, const SafetyStage& safety, Scene& scene) {
    for (std::size_t n = 0; n < objects.alternatives.size(); ++n) {
        const OtherReading& from = objects.alternatives[n];
        Object& object = scene.objects[from.object.place()];
        Alternative to;
        to.probability = from.probability;
        to.whole = from.with;
        to.mass_kg = from.body.candidate.body.mass_kg;
        to.barrier_J = from.body.instability.barrier_J;
        to.barrier_error_J = from.body.barrier_error_J;
        if (from.body.seen_enough() && !safety.disturbances.empty()) {
            to.unsafety_category = safety::to_string(safety.if_otherwise[n]);
            object.unsafety_certain &= to.unsafety_category == object.unsafety_category;
        }
        object.alternatives.push_back(std::move(to));
    }
}

void add_contacts(const ObjectStage& objects, const ToInput& to_input, Scene& scene) {
    const auto object = [&](std::int32_t p) { return objects.object_of_primitive[p]; };
    std::set<std::pair<std::int32_t, std::int32_t>> carries;  // primitives, a < b
    for (const graph::Carrying& c : objects.contacts.carryings) {
        if (c.supporter >= 0) carries.insert(std::minmax(c.supporter, c.supported));
    }
    scene.supports = objects.supports;
    // Their order makes the carriers of each ascend.
    for (const Support& s : scene.supports)
        scene.objects[s.supported].why.stands_on.push_back(s.supporter);
    for (std::size_t i = 0; i < objects.contacts.pairs.size(); ++i) {
        const physics::TouchingPair& pair = objects.contacts.pairs[i];
        Contact c;
        c.a = pair.a;
        c.b = pair.b;
        c.area_m2 = pair.area_m2;
        c.normal = to_input.way(pair.normal);
        const bool same = object(pair.a) == object(pair.b);
        c.relation = same ? "fixed" : carries.contains({pair.a, pair.b}) ? "support" : "adjacent";
        c.probability = objects.pair_probability[i];
        scene.contacts.push_back(std::move(c));
    }
}

void add_fields(const SafetyStage& safety, const ToInput& to_input, Scene& scene) {
    for (const safety::Disturbance& d : safety.disturbances) {
        FieldSamples samples = d.samples;
        for (std::size_t n = 0; n < samples.x.size(); ++n) {
            const Vec3 p = to_input.place({samples.x[n], samples.y[n], samples.z[n]});
            const Vec3 v = to_input.way({samples.vx[n], samples.vy[n], samples.vz[n]});
            samples.x[n] = static_cast<float>(p[0]), samples.vx[n] = static_cast<float>(v[0]);
            samples.y[n] = static_cast<float>(p[1]), samples.vy[n] = static_cast<float>(v[1]);
            samples.z[n] = static_cast<float>(p[2]), samples.vz[n] = static_cast<float>(v[2]);
        }
        scene.fields[d.name] = std::move(samples);
        scene.notes.insert(scene.notes.end(), d.notes.begin(), d.notes.end());
    }
}

void add_walks(const SafetyStage& safety, const ToInput& to_input, Scene& scene) {
    for (const safety::Disturbance& d : safety.disturbances) {
        if (d.walks.visits.empty()) continue;
        scene.walks = d.walks;
        scene.walks.corner_m = to_input.place(d.walks.corner_m);
        scene.walks.along_x_m = to_input.way(d.walks.along_x_m);
        scene.walks.along_y_m = to_input.way(d.walks.along_y_m);
        for (auto& path : scene.walks.paths) {
            for (Vec3& corner : path) corner = to_input.place(corner);
        }
    }
}

void note_doubted_objects(Scene& scene) {
    const auto doubted = std::count_if(scene.objects.begin(), scene.objects.end(),
                                       [](const Object& o) { return o.agreement < 0.5; });
    if (doubted == 0) return;
    const auto movable = std::count_if(scene.objects.begin(), scene.objects.end(),
                                       [](const Object& o) { return !o.grounded; });
    const bool one = doubted == 1;
    scene.notes.push_back("Of " + io::counted(static_cast<std::uint64_t>(movable), "object") +
                          " that can move " + std::to_string(doubted) + (one ? " is" : " are") +
                          " likelier a piece of a thing, or several, than one thing: look at " +
                          (one ? "it" : "them") + ", and correct what is wrong.");
}

// An object of this share of all parts, and this many, is hardly one thing.
constexpr double many_share = 0.15;
constexpr std::size_t many_parts = 40;

void note_crowded_objects(Scene& scene) {
    for (const Object& o : scene.objects) {
        const std::size_t parts = o.primitives.size();
        // What somebody said of it is known.
        if (o.grounded || parts < many_parts || !o.corrected.empty() ||
            static_cast<double>(parts) < many_share * static_cast<double>(scene.primitives.size()))
            continue;
        scene.notes.push_back(
            "Object " + std::to_string(o.id) + " has " + std::to_string(parts) + " of the " +
            std::to_string(scene.primitives.size()) +
            " parts: it is probably several things in one (under-segmentation). What "
            "stands in or on it may be part of it, and then has no risk of its own.");
    }
}

// What was not reckoned with; some comes in only where something is open.
void note_left_out(const SafetyStage& safety, Scene& scene) {
    if (safety.disturbances.empty()) {
        scene.notes.emplace_back(
            "No disturbance was asked for: there are no risks, and no object has an unsafety or a "
            "category. Barriers, and what pushes and blows do, hold.");
        return;
    }
    for (const safety::DisturbanceKind* kind : safety::disturbance_kinds()) {
        const bool reckoned = std::ranges::any_of(
            safety.disturbances, [&](const auto& d) { return d.name == kind->name; });
        if (!reckoned && !safety.below_ceiling && kind->left_out_below_none != nullptr)
            scene.notes.emplace_back(kind->left_out_below_none);
    }
}

// Rates of what falls in weaker earthquakes than those that the hazard curve tells of are bounds.
void note_short_hazard(Scene& scene) {
    const auto from = scene.events.find("hazard_from_g");
    if (from == scene.events.end()) return;
    const auto short_of = std::ranges::count_if(scene.objects, [&](const Object& o) {
        return !o.grounded && safety::falls_below(o.fragility, from->second);
    });
    if (short_of == 0) return;
    const bool one = short_of == 1;
    scene.notes.push_back("The hazard curve begins at " + io::short_number(from->second) +
                          " g, and " + io::counted(static_cast<std::uint64_t>(short_of), "object") +
                          (one ? " falls" : " fall") + " in weaker earthquakes, too: how often " +
                          (one ? "it falls" : "they fall") +
                          " a year is the least that it can be. Let the curve begin at a peak that "
                          "nothing minds.");
}

void note_corrections(Scene& scene) {
    const std::vector<std::size_t> said = told_sentences(scene.corrections);
    for (std::size_t n = 0; n < scene.corrections.size(); ++n) {
        const AppliedCorrection& c = scene.corrections[n];
        if (c.outcome == "held") continue;
        std::string note = "Correction " + std::to_string(said[n]) + " (" +
                           to_string(c.correction.kind) + ") " + (c.held ? "" : "did not hold: ") +
                           c.outcome + ".";
        // One sentence may take several entries.
        if (scene.notes.empty() || scene.notes.back() != note)
            scene.notes.push_back(std::move(note));
    }
}

void note_uncertain_barriers(Scene& scene) {
    const auto uncertain =
        std::count_if(scene.objects.begin(), scene.objects.end(), barrier_within_error);
    if (uncertain == 0) return;
    const auto movable = std::count_if(scene.objects.begin(), scene.objects.end(),
                                       [](const Object& o) { return !o.grounded; });
    scene.notes.push_back("The barrier of " + std::to_string(uncertain) + " of " +
                          io::counted(static_cast<std::uint64_t>(movable), "object") +
                          " that can move is 0 or within its error (the border of its support): " +
                          (uncertain == 1
                               ? "it stands on edge, or the scan does not show what holds it."
                               : "they stand on edge, or the scan does not show what holds them."));
}

}  // namespace

// Of g/cm^3 instead, all would weigh a thousandth.
std::string light_density_note(double density_kg_m3) {
    constexpr double lightest_kg_m3 = 10;  // foams for packing
    if (density_kg_m3 >= lightest_kg_m3) return {};
    return "The density of " + io::short_number(density_kg_m3) +
           " kg/m\u00b3 is less than that of the lightest foam; if it is in g/cm\u00b3, give "
           "density_kg_m3 (--density) 1000 times as large.";
}

void record_run(const device::Device& device, const ParseOptions& options, double voxel_m,
                Scene& scene) {
    scene.topple_version = version;
    scene.backend = device::to_string(device.info().backend);
    scene.device = device.info().name;
    scene.seed = options.seed;
    scene.voxel_size_m = voxel_m;
    scene.density_kg_m3 = options.density_kg_m3;
    scene.friction = options.friction;
    if (options.people != ParseOptions{}.people) scene.people = options.people;
    scene.events["tolerable_J"] = options.tolerable_J;
    for (const safety::DisturbanceKind* kind : safety::acting_kinds(options))
        scene.events.merge(kind->events(options));
}

void assemble_objects(const SolidParts& parts, const ObjectStage& objects,
                      const SafetyStage& safety, Scene& scene) {
    const std::array<Vec3, 3>& axes = parts.frame.axes;
    const ToInput to_input(parts.frame);
    scene.up = axes[2];
    scene.up_method = parts.frame.up_method;
    scene.manhattan_found = parts.frame.found;
    const Vec3 to = opposite(turned(axes, parts.frame.origin_m));
    scene.manhattan_from_input = {axes[0][0], axes[0][1], axes[0][2], to[0],  //
                                  axes[1][0], axes[1][1], axes[1][2], to[1],  //
                                  axes[2][0], axes[2][1], axes[2][2], to[2],  //
                                  0,          0,          0,          1};
    add_primitives(parts, objects, to_input, scene);
    add_objects(objects, safety, to_input, scene);
    add_alternatives(objects, safety, scene);
    scene.possible_things = possible_things(parts.solids->cells(), objects, safety, to_input);
    add_contacts(objects, to_input, scene);
    add_fields(safety, to_input, scene);
    add_walks(safety, to_input, scene);
    scene.corrections = objects.told.corrections;
    const std::string light = light_density_note(scene.density_kg_m3);
    if (!light.empty()) scene.notes.push_back(light);
    note_corrections(scene);
    note_doubted_objects(scene);
    note_crowded_objects(scene);
    const std::string possible = possible_things_note(scene.possible_things);
    if (!possible.empty()) scene.notes.push_back(possible);
    note_uncertain_barriers(scene);
    note_left_out(safety, scene);
    note_short_hazard(scene);
    scene.swc_energy = objects.grouping.energy_curve;
    explain(objects, to_input, scene);
    predict_falls(objects, safety, to_input, scene);
    write_reasons(parts, objects, safety.landings, scene);
    write_advice(safety.advice, scene);
}

std::map<std::string, SpaceField> take_space_fields(const SolidParts& parts, SafetyStage& safety) {
    const ToInput to_input(parts.frame);
    std::map<std::string, SpaceField> out;
    for (safety::Disturbance& d : safety.disturbances) {
        if (!d.space) continue;
        SpaceField& field = out[d.name] = std::move(*d.space);
        d.space.reset();
        field.corner_m = to_input.place(field.corner_m);
        for (Vec3& along : field.along_m) along = to_input.way(along);
        for (auto& v : field.velocity_m_s) {
            const Vec3 way = to_input.way({v[0], v[1], v[2]});
            for (std::size_t a = 0; a < 3; ++a) v[a] = static_cast<float>(way[a]);
        }
    }
    return out;
}

void add_exposures(const SafetyStage& safety, const SolidCells& cells, vdb::VoxelScene& voxels) {
    for (const safety::Disturbance& d : safety.disturbances)
        if (!d.exposure.empty()) voxels.add_field(d.name, cells.i, cells.j, cells.k, d.exposure);
}

void assemble_points(FoundParts found, const ObjectStage& objects, const SafetyStage& safety,
                     Scene& scene) {
    ScenePoints& points = scene.points = std::move(found.points);
    if (objects.taken) {
        for (std::int32_t& p : points.primitive)
            if (p >= 0) p = objects.taken->number[p];
    }
    points.object.reserve(points.primitive.size());
    for (const std::int32_t p : points.primitive)
        points.object.push_back(p < 0 ? -1 : objects.object_of_primitive[p]);
    const SolidScene& solids = *found.parts.solids;
    found.voxels->set_objects(objects.object_of_primitive);
    scene.solid =
        vdb::solid_voxels(found.voxels->frame(), solids.with_strays(), objects.object_of_primitive);
    add_exposures(safety, solids.cells(), *found.voxels);
}

}  // namespace topple
