// SPDX-License-Identifier: MIT
#pragma once

#include "graph/contact_graph.h"
#include "graph/stable_objects.h"
#include "host/safety/room.h"
#include "objects/object_stage.h"
#include "objects/stops.h"
#include "physics/part_hulls.h"
#include "safety/safety_stage.h"

namespace topple::test {

// A room of boxes with the barriers and S(W) that a parse would give to its objects. The room holds
// the cells.
struct AssessedRoom {
    safety::Surroundings around;
    SolidScene solids;
    std::vector<Body> objects;
    std::vector<safety::RiskObject> at_risk;
    SolidParts parts;
    ObjectStage stage;

    AssessedRoom(device::Device& device, Room& room, double friction)
        : around(room.surroundings()),
          solids(*around.cells, std::vector<Role>(room.object_of_primitive.size())) {
        const SolidCells& cells = solids.cells();
        const auto primitives = static_cast<std::int32_t>(room.object_of_primitive.size());
        const auto bodies = physics::mass_properties(device, cells, primitives, room.density_kg_m3);
        const graph::ContactGraph contacts = graph::build_contact_graph(device, cells, primitives);
        const physics::PartHulls hulls = physics::part_hulls(
            cells, {}, std::vector<bool>(room.object_of_primitive.size(), true), device.threads());
        std::vector<double> density(room.objects.size(), 0.0);  // by object
        for (std::size_t p = room.object_of_primitive.size(); p-- > 0;)
            density[room.object_of_primitive[p]] = room.density_kg_m3[p];
        const auto inertia =
            physics::inertia_of_objects(physics::second_moments(cells, primitives, {}), bodies,
                                        room.object_of_primitive, density);
        for (std::size_t o = 0; o < room.objects.size(); ++o) {
            std::vector<std::int32_t> members;
            for (std::int32_t p = 0; p < primitives; ++p) {
                if (room.object_of_primitive[p] == static_cast<std::int32_t>(o))
                    members.push_back(p);
            }
            Body object;
            object.grounded = room.objects[o].grounded;
            object.lowest_m = contacts.lowest_m[members.front()];
            object.highest_m = contacts.highest_m[members.front()];
            for (const std::int32_t p : members) {
                object.lowest_m = std::min(object.lowest_m, contacts.lowest_m[p]);
                object.highest_m = std::max(object.highest_m, contacts.highest_m[p]);
            }
            object.candidate =
                graph::candidate_of(contacts, bodies, around.is_floor_primitive, members);
            object.inertia = inertia[o];
            object.friction.coefficient = friction;
            objects.push_back(std::move(object));
        }
        stage.objects = objects;
        stage.object_of_primitive = room.object_of_primitive;
        find_barriers(device, hulls, solids, {}, Stops(stage), room.object_of_primitive, objects);
        at_risk = risk_objects(objects);
        parts.solids = {&solids, [](const SolidScene*) {}};
        stage.objects = objects;
    }
    AssessedRoom(const AssessedRoom&) = delete;
};

}  // namespace topple::test
