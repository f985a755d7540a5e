// SPDX-License-Identifier: MIT
#include "objects/alternatives.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "graph/undersides.h"
#include "physics/inertia.h"

namespace topple {
namespace {

// A reading that is less likely is not told.
constexpr double least_alternative = 0.25;

using Parts = std::vector<std::int32_t>;

// A reading whose bodies are to be found.
struct Wanted {
    OtherReading reading;
    std::vector<Parts> bodies;  // one, or two
};

// found: those whose bodies are known without.
std::vector<Wanted> wanted(std::span<const graph::Joint> joints, const graph::KnownLinks& links,
                           const ObjectStage& stage, std::vector<OtherReading>& found) {
    const auto primitives = [&](ObjectId o) { return stage.objects[o].candidate.primitives; };
    std::vector<Wanted> out;
    const auto add = [&](ObjectId object, double probability, ObjectId with,
                         std::vector<Parts> bodies) {
        Wanted& w = out.emplace_back();
        w.reading.object = object;
        w.reading.probability = probability;
        w.reading.with = with;
        w.bodies = std::move(bodies);
    };
    for (std::size_t o = 0; o < stage.objects.size(); ++o) {
        const Body& object = stage.objects[o];
        if (object.grounded) continue;
        if (object.piece.probability >= least_alternative) {
            const ObjectId with = stage.object_of_primitive[object.piece.primitive];
            const Body& whole = stage.objects[with];
            if (static_cast<double>(object.candidate.body.voxels) <
                graph::least_part * static_cast<double>(whole.candidate.body.voxels)) {
                // Of which it would change little.
                found.push_back({o, object.piece.probability, with, whole});
            } else {
                Parts both = primitives(o);
                for (const std::int32_t p : primitives(with)) both.push_back(p);
                add(o, object.piece.probability, with, {std::move(both)});
            }
        }
        const double two = 1 - object.weakest.probability;
        if (two >= least_alternative)
            add(o, two, {}, graph::both_sides(joints, links, primitives(o), object.weakest));
    }
    std::ranges::stable_sort(out, std::ranges::greater{},
                             [](const Wanted& w) { return w.reading.probability; });
    return out;
}

// Takes those from the list of which no two want the same object.
std::vector<Wanted> next_round(std::vector<Wanted>& wanted, std::size_t objects) {
    std::vector<Wanted> round, later;
    std::vector<bool> taken(objects);
    for (Wanted& w : wanted) {
        // Two things are one object.
        const ObjectId a = w.reading.object, b = w.reading.with < 0 ? a : w.reading.with;
        const bool free = !taken[a.place()] && !taken[b.place()];
        if (free) taken[a.place()] = taken[b.place()] = true;
        (free ? round : later).push_back(std::move(w));
    }
    wanted = std::move(later);
    return round;
}

// Fills in the bodies of readings that share no object. The building is the first body of all; what
// no reading is about stands where it is, and is nobody's.
void find_bodies(device::Device& device, const physics::PartHulls& hulls, const SolidParts& parts,
                 const BodyMaker& maker, double friction, const ObjectStage& stage,
                 std::vector<Wanted>& round) {
    const SolidScene& solids = *parts.solids;
    std::vector<Parts> members(1);
    for (const Body& object : stage.objects)
        if (object.grounded) members.front() = object.candidate.primitives;
    for (Wanted& w : round)
        for (Parts& body : w.bodies) members.push_back(std::move(body));
    Table<PrimitiveId, std::int32_t> object_of(stage.object_of_primitive.size(), -1);
    for (std::size_t o = 0; o < members.size(); ++o)
        for (const std::int32_t p : members[o]) object_of[p] = static_cast<std::int32_t>(o);
    const auto columns = graph::undersides(solids.cells(), object_of, members.size());
    std::vector<Body> bodies(members.size());
    device.threads().each(members.size(), 1, [&](std::size_t o) {
        bodies[o] = maker.made(std::move(members[o]), columns[o], o == 0);
    });
    std::vector<double> density;
    for (const Body& body : bodies) {
        const physics::MassProperties& all = body.candidate.body;
        density.push_back(all.volume_m3 > 0 ? all.mass_kg / all.volume_m3 : 0);
    }
    const std::vector<physics::Symmetric> inertia =
        physics::inertia_of_objects(stage.masses.moments, stage.bodies, object_of, density);
    for (std::size_t o = 0; o < bodies.size(); ++o) bodies[o].inertia = inertia[o];
    find_barriers(device, hulls, solids, stage.hidden_walls, object_of, friction, bodies,
                  unseen_of(parts), false);
    std::size_t next = 1;
    for (Wanted& w : round) {
        const auto first = bodies.begin() + static_cast<std::ptrdiff_t>(next);
        next += w.bodies.size();
        w.reading.body = std::move(*std::ranges::min_element(
            first, first + static_cast<std::ptrdiff_t>(w.bodies.size()), {},
            [](const Body& body) { return body.instability.barrier_J; }));
    }
}

}  // namespace

std::vector<OtherReading> find_alternatives(device::Device& device, const physics::PartHulls& hulls,
                                            const SolidParts& parts, const BodyMaker& maker,
                                            std::span<const graph::Joint> joints,
                                            const graph::KnownLinks& links, double friction,
                                            const ObjectStage& stage) {
    std::vector<OtherReading> out;
    std::vector<Wanted> left = wanted(joints, links, stage, out);
    while (!left.empty()) {
        std::vector<Wanted> round = next_round(left, stage.objects.size());
        find_bodies(device, hulls, parts, maker, friction, stage, round);
        for (Wanted& w : round) out.push_back(std::move(w.reading));
    }
    std::ranges::stable_sort(out, [](const OtherReading& a, const OtherReading& b) {
        return a.object != b.object ? a.object < b.object : a.probability > b.probability;
    });
    return out;
}

}  // namespace topple
