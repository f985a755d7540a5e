// SPDX-License-Identifier: MIT
#include "objects/bodies_if.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "graph/undersides.h"
#include "objects/stops.h"
#include "physics/inertia.h"

namespace topple {

std::vector<Body> BodiesIf::operator()(std::vector<std::vector<std::int32_t>> primitives) const {
    const SolidScene& solids = *parts.solids;
    // The building comes first.
    Table<PrimitiveId, std::int32_t> object_of;
    for (const std::int32_t o : stage.object_of_primitive)
        object_of.push_back(stage.objects[o].grounded ? 0 : -1);
    for (std::size_t n = 0; n < primitives.size(); ++n)
        for (const std::int32_t p : primitives[n]) object_of[p] = static_cast<std::int32_t>(n + 1);
    std::vector<std::int32_t> building;
    for (std::size_t p = 0; p < object_of.size(); ++p)
        if (object_of[p] == 0) building.push_back(static_cast<std::int32_t>(p));
    primitives.insert(primitives.begin(), std::move(building));
    const auto columns = graph::undersides(solids.cells(), object_of, primitives.size());
    std::vector<Body> bodies(primitives.size());
    device.threads().each(primitives.size(), 1, [&](std::size_t o) {
        bodies[o] = maker.made(std::move(primitives[o]), columns[o], o == 0);
    });
    std::vector<double> density;
    for (const Body& body : bodies) density.push_back(body.candidate.body.density_kg_m3());
    const std::vector<physics::Symmetric> inertia =
        physics::inertia_of_objects(stage.masses.moments, stage.bodies, object_of, density);
    for (std::size_t o = 0; o < bodies.size(); ++o) {
        bodies[o].inertia = inertia[o];
        const std::vector<std::int32_t>& members = bodies[o].candidate.primitives;
        if (!members.empty())
            bodies[o].friction =
                stage.masses.objects[stage.object_of_primitive[members[0]]].friction;
    }
    find_barriers(device, hulls, solids, stage.hidden_walls, Stops(stage), object_of, bodies,
                  unseen_of(parts), false);
    bodies.erase(bodies.begin());
    return bodies;
}

}  // namespace topple
