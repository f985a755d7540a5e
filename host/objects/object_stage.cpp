// SPDX-License-Identifier: MIT
#include "objects/object_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/thread_pool.h"
#include "fitted/boosted_trees.h"
#include "geometry/primitive_shapes.h"
#include "graph/building_pieces.h"
#include "graph/false_feet.h"
#include "objects/alternatives.h"
#include "objects/body_maker.h"
#include "objects/find_hidden_walls.h"
#include "objects/stops.h"
#include "physics/assess.h"
#include "physics/body_landscape.h"
#include "physics/directions.h"
#include "physics/drop.h"
#include "physics/leaning.h"
#include "physics/overturning.h"
#include "physics/part_hulls.h"

namespace topple {
namespace {
graph::ShellOdds shell_odds(Table<PrimitiveId, double> log_odds) {
    graph::ShellOdds out;
    for (const double odds : log_odds)
        out.pinned.push_back(odds > fitted::log_odds(graph::surely_shell));
    // Something is the ground that all else stands on: a table in a close view.
    if (!log_odds.empty() && std::ranges::find(out.pinned, true) == out.pinned.end())
        out.pinned[std::ranges::max_element(log_odds) - log_odds.begin()] = true;
    out.log_odds = std::move(log_odds);
    return out;
}

void add_independent(const physics::BodyError& more, physics::BodyError& to) {
    to.mass_kg = std::hypot(to.mass_kg, more.mass_kg);
    for (std::size_t a = 0; a < 3; ++a)
        to.center_m[a] = std::hypot(to.center_m[a], more.center_m[a]);
}

// The ground comes first, where there is one.
std::int32_t grounded_object(const ObjectStage& of) {
    const auto& group = of.grouping.group;
    return std::ranges::find(group, -1) == group.end() ? -1 : 0;
}

void number_objects(ObjectStage& out) {
    const std::int32_t grounded = grounded_object(out);
    for (const std::int32_t g : out.grouping.group)
        out.object_of_primitive.push_back(g + grounded + 1);
}

std::size_t object_count(const ObjectStage& of) {
    std::int32_t last = -1;
    for (const std::int32_t o : of.object_of_primitive) last = std::max(last, o);
    return static_cast<std::size_t>(last + 1);
}

// The voxels that the surface of each primitive was seen in.
Table<PrimitiveId, std::uint64_t> seen_voxels(const SolidCells& cells, std::size_t primitives) {
    Table<PrimitiveId, std::uint64_t> seen(primitives, 0);
    for (std::size_t n = 0; n < cells.size(); ++n)
        if (cells.primitive[n] >= 0 && cells.basis[n] == Basis::surface) ++seen[cells.primitive[n]];
    return seen;
}

// What objects may be pieces of, and whether they may be several.
void doubt_objects(std::span<const graph::Joint> joints, const graph::KnownLinks& links,
                   TableView<PrimitiveId, std::uint64_t> seen, ObjectStage& out) {
    Table<ObjectId, std::uint64_t> of_objects(out.objects.size(), 0);  // none of the ground
    for (std::size_t p = 0; p < seen.size(); ++p) {
        const ObjectId o = out.object_of_primitive[p];
        if (!out.objects[o].grounded) of_objects[o] += seen[p];
    }
    const graph::LinkedNodes nodes(static_cast<std::int32_t>(seen.size()), links);
    const Table<ObjectId, graph::PieceOf> pieces =
        graph::likely_pieces(joints, links, out.object_of_primitive, of_objects);
    const Table<ObjectId, graph::WeakestJoint> weakest =
        graph::weakest_joints(joints, links, out.object_of_primitive, seen, out.objects.size());
    for (std::size_t o = 0; o < out.objects.size(); ++o) {
        Body& object = out.objects[o];
        object.piece = pieces[o];
        if (object.grounded) continue;
        object.weakest = weakest[o];
        const std::vector<std::int32_t>& parts = object.candidate.primitives;
        const bool known = parts.size() > 1 && std::ranges::all_of(parts, [&](std::int32_t p) {
                               return nodes.one_object(parts.front(), p) == true;
                           });
        object.agreement =
            known ? 1
                  : graph::whole_probability(pieces[o], weakest[o], object.candidate.body.voxels);
    }
}

// Of the building no piece that is less likely a thing is told.
constexpr double least_possible = 0.25;

// The likely ones of the building's pieces, whose bodies are not known yet.
void number_possible_things(std::vector<graph::BuildingPiece> pieces, ObjectStage& out) {
    const auto objects = static_cast<std::int32_t>(object_count(out));
    out.body_of_primitive = out.object_of_primitive;
    for (graph::BuildingPiece& piece : pieces) {
        if (piece.probability < least_possible) continue;
        const auto body = objects + static_cast<std::int32_t>(out.possible_things.size());
        for (const std::int32_t p : piece.primitives) out.body_of_primitive[p] = body;
        PossibleBody& thing = out.possible_things.emplace_back();
        thing.probability = piece.probability;
        thing.body.candidate.primitives = std::move(piece.primitives);
    }
}

void find_possible_things(const BodiesIf& bodies_if, ObjectStage& out) {
    std::vector<std::vector<std::int32_t>> primitives;
    for (PossibleBody& thing : out.possible_things)
        primitives.push_back(std::move(thing.body.candidate.primitives));
    std::vector<Body> bodies = bodies_if(std::move(primitives));
    for (std::size_t n = 0; n < bodies.size(); ++n) {
        take_mass(out.masses.objects[out.objects.size() + n], bodies[n]);
        out.possible_things[n].body = std::move(bodies[n]);
    }
}

// The building's own, with that of what may be a thing.
void take_whole_inertia(ObjectStage& out) {
    Body& building = out.objects.front();
    std::vector<std::int32_t> of_building;
    for (const std::int32_t o : out.object_of_primitive) of_building.push_back(o == 0 ? 0 : -1);
    const std::array density{building.candidate.body.density_kg_m3()};
    building.inertia =
        physics::inertia_of_objects(out.masses.moments, out.bodies, of_building, density).front();
}

// Objects by group, the ground first.
void collect_objects(const SolidScene& solids, const BodyMaker& maker, const ParseOptions& options,
                     ThreadPool& threads, HandCorrections& hand, ObjectStage& out) {
    const Table<PrimitiveId, std::int32_t>& group = out.grouping.group;
    const std::size_t objects = object_count(out);
    const std::int32_t grounded = grounded_object(out);
    Table<ObjectId, KnownMass> known = hand.masses(out.object_of_primitive, objects, grounded);
    known.resize(objects + out.possible_things.size());
    out.masses = weigh_objects(solids, out.body_of_primitive, known, grounded, options, out.bodies);
    Table<ObjectId, std::vector<std::int32_t>> members(objects);
    for (std::size_t p = 0; p < group.size(); ++p)
        members[out.object_of_primitive[p]].push_back(static_cast<std::int32_t>(p));
    const auto columns = graph::undersides(solids.cells(), out.object_of_primitive, members.size());
    out.floors = FloorHeights(solids);
    out.objects.resize(members.size());
    threads.each(members.size(), 1, [&](std::size_t o) {
        Body& object = out.objects[o];
        object =
            maker.made(std::move(members[o]), columns[o], grounded == static_cast<std::int32_t>(o));
        take_mass(out.masses.objects[o], object);
    });
    if (grounded == 0) take_whole_inertia(out);
    Table<ObjectId, graph::Carried> carried;
    for (const Body& o : out.objects) carried.push_back({o.grounded, o.candidate.body.mass_kg});
    out.supports = graph::find_supports(out.contacts, out.pair_probability, out.object_of_primitive,
                                        carried, columns);
}

}  // namespace

void take_mass(const ObjectMasses::Object& mass, Body& object) {
    object.mass_model = mass.model;
    object.inertia = mass.inertia;
    object.drawers = mass.drawers;
    object.friction = mass.friction;
    add_independent(mass.contents_error, object.body_error);
    // What is off of alike things holds what is off of each by itself.
    object.body_error.mass_kg = std::max(object.body_error.mass_kg, mass.alike_error_kg);
    object.density_error_kg = mass.density_error_share * object.candidate.body.mass_kg;
    if (mass.weighed) object.body_error.mass_kg = object.density_error_kg = 0;
}

PartStage weigh_parts(device::Device& device, const SolidParts& parts, const ParseOptions& options,
                      StageClock& stage) {
    const auto count = static_cast<std::int32_t>(parts.model.size());
    const std::vector<double> density(static_cast<std::size_t>(count), options.density_kg_m3);
    const SolidCells& cells = parts.solids->cells();
    std::vector<physics::MassProperties> bodies =
        stage("bodies", [&] { return physics::mass_properties(device, cells, count, density); });
    graph::ContactGraph contacts =
        stage("contacts", [&] { return graph::build_contact_graph(device, cells, count); });
    graph::Judged judged = stage("joints", [&] {
        return graph::judge_joints(device, parts.samples,
                                   geometry::primitive_shapes(parts.samples, parts.model.size()),
                                   contacts, bodies, parts.seams, parts.shell_log_odds);
    });
    return {std::move(bodies), std::move(contacts), std::move(judged.joints),
            shell_odds(std::move(judged.shell))};
}

physics::Toppling toppling_of(const Body& object, const physics::Stability& tipping) {
    return {object.candidate, {object.inertia, object.highest_m}, tipping, safety::directions(),
            object.sliding,   object.friction.coefficient};
}

Table<PrimitiveId, bool> fixed_primitives(ObjectOf object_of, TableView<ObjectId, Body> objects) {
    Table<PrimitiveId, bool> out;
    for (std::size_t p = 0; p < object_of.primitives(); ++p) {
        const ObjectId o = object_of(p);
        out.push_back(o >= 0 && objects[o].grounded);
    }
    return out;
}

void find_barriers(device::Device& device, const physics::PartHulls& parts,
                   const SolidScene& solids, const physics::HiddenWalls& walls, const Stops& stops,
                   ObjectOf object_of, std::vector<Body>& objects, const Unseen& unseen,
                   bool landscapes) {
    const SolidCells& cells = solids.cells();
    const CellColumns& columns = solids.columns();
    const std::vector<ObjectBox> boxes = object_boxes(solids, object_of, objects.size());
    for (std::size_t o = 0; o < objects.size(); ++o) objects[o].box = boxes[o];
    std::vector<physics::Candidate> candidates;
    for (Body& o : objects) {
        if (!o.grounded && !o.candidate.support_polygon.empty())
            o.candidate.edge_drop_m =
                physics::drops_when_tipped_m(cells, columns, o.candidate, unseen);
        candidates.push_back(o.candidate);
    }
    std::vector<physics::StandingHull> hulls(objects.size());
    std::vector<physics::Stability> tipping(objects.size()), level(objects.size());
    device.threads().each(objects.size(), 1, [&](std::size_t o) {
        const physics::Candidate& c = candidates[o];
        hulls[o] = physics::standing_hull(parts, c);
        tipping[o] = physics::assess(hulls[o], c);
        level[o] = tipping[o];
        if (std::ranges::none_of(c.edge_drop_m, [](double drop) { return drop > 0; })) return;
        physics::Candidate on_level = c;
        on_level.edge_drop_m.clear();
        level[o] = physics::assess(hulls[o], on_level);
    });
    std::vector<physics::MassProperties> bodies;
    // What is fixed to the ground does not slide: no mass, nothing to search.
    for (const Body& o : objects)
        bodies.push_back(o.grounded ? physics::MassProperties{} : o.candidate.body);
    std::vector<physics::KnownFooting> stances;
    for (const Body& o : objects) {
        stances.push_back({o.candidate.stood ? o.candidate.support_polygon : physics::Polygon{},
                           o.candidate.support_height_m, o.rest != graph::RestKind::seen});
    }
    std::vector<double> friction;
    for (const Body& o : objects) friction.push_back(o.friction.coefficient);
    std::vector<physics::SlideResult> sliding =
        physics::slide_all(cells, object_of, bodies, friction,
                           {.places = landscapes,
                            .stances = stances,
                            .ways = safety::directions(),
                            .threads = &device.threads(),
                            .unseen = unseen});
    device.threads().each(objects.size(), 1, [&](std::size_t o) {
        if (objects[o].grounded) return;
        objects[o].open_tipping = tipping[o];
        const physics::Candidate& c = candidates[o];
        if (auto beside = physics::beside_fixed(cells, columns, walls, c,
                                                stops.of(c.primitives, c.body.mass_kg),
                                                objects[o].highest_m, tipping[o]))
            tipping[o] = std::move(*beside);
        physics::Instability& how = objects[o].instability;
        how = physics::combine_curves(tipping[o], sliding[o]);
        if (how.mode == physics::Instability::Mode::tip && how.drop_m > 0)
            how.onto = physics::met_when_tipped(cells, columns, candidates[o], how.weakest,
                                                (*how.edge)[0]);
        objects[o].barrier_error_J =
            physics::barrier_error_J(candidates[o], objects[o].body_error, tipping[o], how,
                                     objects[o].margin_error_m, objects[o].friction);
        objects[o].seen_error_J = objects[o].barrier_error_J;
        // Its upper end is that of a foot that goes on unseen.
        if (how.mode != physics::Instability::Mode::slide)
            objects[o].barrier_error_J =
                std::max(objects[o].barrier_error_J,
                         physics::tipping_barrier_J(candidates[o], objects[o].unseen_margin_m) -
                             how.barrier_J);
        objects[o].overturning = physics::overturning(
            candidates[o], objects[o].body_error, tipping[o], objects[o].box.top_m(),
            objects[o].margin_error_m, objects[o].friction, objects[o].floor_m);
        objects[o].tipping = std::move(tipping[o]);
        objects[o].level_tipping = std::move(level[o]);
        objects[o].sliding = std::move(sliding[o]);
        if (!candidates[o].support_polygon.empty())
            objects[o].toppling =
                std::make_shared<physics::Toppling>(toppling_of(objects[o], objects[o].tipping));
        if (landscapes)
            objects[o].poses =
                physics::body_landscape(hulls[o], candidates[o], objects[o].tipping.ways);
    });
}

ObjectStage find_objects(device::Device& device, const ParseOptions& options, StageClock& stage,
                         SolidParts& solid) {
    return find_objects(device, options, stage, solid, weigh_parts(device, solid, options, stage));
}

ObjectStage find_objects(device::Device& device, const ParseOptions& options, StageClock& stage,
                         SolidParts& solid, PartStage parts) {
    ObjectStage out;
    HandCorrections hand(options.corrections, solid);
    stage("grouping", [&] {
        graph::GroupingOptions grouping;
        grouping.seed = options.seed;
        grouping.stability_level = options.stability_level;
        grouping.time_limit_s = options.grouping_time_s.value_or(0);
        grouping.cancelled = options.cancelled;
        const auto group = [&] {
            return graph::group_primitives(device, parts.contacts, parts.bodies, parts.joints,
                                           parts.shell, grouping);
        };
        out.grouping = group();
        if (!hand.links().none()) {
            grouping.links = hand.links();
            grouping.before = std::move(out.grouping.group);
            hand.keep_apart(*solid.solids, parts.shell);
            out.grouping = group();
            hand.look_at_joined(grouping.before, out.grouping.group);
        }
        out.taken = hand.take_from(solid, out.grouping, parts.shell, parts.joints);
        hand.fix(solid, out.grouping, parts.shell);
        number_objects(out);
        // Joints were judged with all that was completed, as their models were fitted.
        solid.solids =
            graph::without_false_feet(solid.solids, out.object_of_primitive, grounded_object(out));
    });
    const SolidCells& cells = solid.solids->cells();
    const BoundaryCells& boundary = solid.solids->boundary();
    const Table<PrimitiveId, std::uint64_t> seen = seen_voxels(cells, solid.model.size());
    number_possible_things(graph::building_pieces(parts.joints, hand.links(), hand.fixed(),
                                                  parts.shell, out.grouping, seen),
                           out);
    const std::vector<double> density(solid.model.size(), options.density_kg_m3);
    out.bodies = stage("masses", [&] {
        return physics::mass_properties(device, cells, static_cast<std::int32_t>(density.size()),
                                        density, boundary);
    });
    // The models of joints know contacts of whole voxels; what follows takes their true borders.
    const auto count = static_cast<std::int32_t>(solid.model.size());
    out.contacts = stage(
        "borders", [&] { return graph::build_contact_graph(device, cells, count, boundary); });
    out.pair_probability =
        graph::pair_probabilities(out.contacts, parts.joints, parts.shell, hand.links());
    const physics::PartHulls hulls = stage("supports", [&] {
        // All but the building's, and what of that may be a thing.
        const std::int32_t grounded = grounded_object(out);
        std::vector<bool> loose;
        for (const std::int32_t o : out.body_of_primitive) loose.push_back(o != grounded);
        return physics::part_hulls(cells, boundary, loose, device.threads());
    });
    const BodyMaker maker = stage("barriers", [&] {
        BodyMaker made(*solid.solids, out, parts.shell.pinned, solid.sensed != nullptr);
        collect_objects(*solid.solids, made, options, device.threads(), hand, out);
        out.hidden_walls = find_hidden_walls(
            solid, out.object_of_primitive, fixed_primitives(out.object_of_primitive, out.objects));
        find_barriers(device, hulls, *solid.solids, out.hidden_walls, Stops(out),
                      out.object_of_primitive, out.objects, unseen_of(solid));
        return made;
    });
    doubt_objects(parts.joints, hand.links(), seen, out);
    stage("alternatives", [&] {
        const BodiesIf bodies_if{device, hulls, solid, maker, out};
        out.alternatives = find_alternatives(bodies_if, parts.joints, hand.links());
        if (!out.possible_things.empty()) find_possible_things(bodies_if, out);
    });
    out.told = hand.tell(out.object_of_primitive, out.objects.size(), grounded_object(out));
    return out;
}

}  // namespace topple
