// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "core/solid_scene.h"
#include "core/sort_unique.h"
#include "live/appeared.h"
#include "objects/body_maker.h"
#include "objects/floor_heights.h"
#include "objects/stops.h"
#include "physics/part_hulls.h"
#include "safety/disturbances.h"
#include "safety/risk_error.h"
#include "safety/safety_stage.h"
#include "vdb/voxel_scene.h"

namespace topple::live {
namespace {

std::vector<Role> roles_of(const SolidScene& solids, std::size_t bodies) {
    std::vector<Role> out;
    for (std::size_t p = 0; p < solids.primitives(); ++p)
        out.push_back(solids.role(static_cast<std::int32_t>(p)));
    out.resize(out.size() + bodies, Role::none);
    return out;
}

struct Cell {
    Place at;
    std::int32_t primitive;
    Basis basis;
};

// Cells and those of new bodies, each a primitive behind the `primitives` that there are; where two
// lie at one place the first one counts.
SolidCells with_bodies(std::vector<Cell> cells, double voxel_m,
                       std::span<const std::vector<Place>> bodies, std::size_t primitives,
                       const auto& placed) {
    auto primitive = static_cast<std::int32_t>(primitives);
    for (const std::vector<Place>& body : bodies) {
        for (const Place& at : body) cells.push_back({placed(at), primitive, Basis::surface});
        ++primitive;
    }
    sort_unique(cells, &Cell::at);
    SolidCells out;
    out.voxel_m = voxel_m;
    for (const Cell& cell : cells) out.add(cell.at, cell.primitive, cell.basis);
    return out;
}

// All of a scene with the bodies, by its own voxels.
SolidScene whole_scene(const SolidScene& solids, std::span<const std::vector<Place>> bodies) {
    const SolidCells& from = solids.cells();
    std::vector<Cell> cells;
    for (std::size_t n = 0; n < from.size(); ++n)
        cells.push_back({place_of(from, n), from.primitive[n], from.basis[n]});
    return {with_bodies(std::move(cells), from.voxel_m, bodies, solids.primitives(), coarse),
            roles_of(solids, bodies.size())};
}

// What lies around the bodies, as far as it may touch them or be in their way, by their voxels.
SolidScene near_scene(const SolidScene& solids, std::span<const std::vector<Place>> bodies) {
    constexpr double around_m = 0.2;
    const SolidCells& from = solids.cells();
    const auto reach = static_cast<std::int32_t>(std::ceil(around_m / from.voxel_m));
    struct Box {
        Place low, high;
    };
    std::vector<Box> boxes;
    for (const std::vector<Place>& body : bodies) {
        Box& box = boxes.emplace_back(Box{coarse(body.front()), coarse(body.front())});
        for (const Place& at : body)
            for (std::size_t a = 0; a < 3; ++a) {
                box.low[a] = std::min(box.low[a], coarse(at)[a] - reach);
                box.high[a] = std::max(box.high[a], coarse(at)[a] + reach);
            }
    }
    std::vector<Cell> cells;
    for (std::size_t n = 0; n < from.size(); ++n) {
        const Place at = place_of(from, n);
        const bool near = std::ranges::any_of(boxes, [&](const Box& box) {
            return at[0] >= box.low[0] && at[0] <= box.high[0] && at[1] >= box.low[1] &&
                   at[1] <= box.high[1] && at[2] >= box.low[2] && at[2] <= box.high[2];
        });
        for (std::int32_t part = 0; near && part < finer * finer * finer; ++part) {
            const Place within{part / (finer * finer), part / finer % finer, part % finer};
            cells.push_back(
                {{finer * at[0] + within[0], finer * at[1] + within[1], finer * at[2] + within[2]},
                 from.primitive[n],
                 from.basis[n]});
        }
    }
    return {with_bodies(std::move(cells), from.voxel_m / finer, bodies, solids.primitives(),
                        [](const Place& at) { return at; }),
            roles_of(solids, bodies.size())};
}

// Object 0: all that was there; then one for each body.
ObjectStage stage_of(device::Device& device, const SolidScene& near, const FloorHeights& floors,
                     std::size_t bodies, const ParseOptions& options) {
    ObjectStage out;
    const std::size_t before = near.primitives() - bodies;
    out.object_of_primitive.resize(near.primitives(), 0);
    for (std::size_t n = 0; n < bodies; ++n)
        out.object_of_primitive[before + n] = static_cast<std::int32_t>(n + 1);
    out.body_of_primitive = out.object_of_primitive;
    const auto count = static_cast<std::int32_t>(near.primitives());
    const std::vector<double> density(near.primitives(), options.density_kg_m3);
    out.bodies = physics::mass_properties(device, near.cells(), count, density);
    out.contacts = graph::build_contact_graph(device, near.cells(), count);
    const Table<ObjectId, KnownMass> known(bodies + 1);
    out.masses = weigh_objects(near, out.object_of_primitive, known, 0, options, out.bodies);
    out.floors = floors;
    const Table<PrimitiveId, bool> shell(near.primitives(), false);
    const BodyMaker maker(near, out, shell, true);
    const auto columns = graph::undersides(near.cells(), out.object_of_primitive, bodies + 1);
    out.objects.resize(bodies + 1);
    for (std::size_t o = 0; o <= bodies; ++o) {
        std::vector<std::int32_t> members;
        for (std::int32_t p = 0; p < count; ++p)
            if (out.object_of_primitive[p] == static_cast<std::int32_t>(o)) members.push_back(p);
        out.objects[o] = maker.made(std::move(members), columns[o], o == 0);
        take_mass(out.masses.objects[o], out.objects[o]);
    }
    std::vector<bool> loose;
    for (const std::int32_t o : out.object_of_primitive) loose.push_back(o > 0);
    const physics::PartHulls hulls =
        physics::part_hulls(near.cells(), near.boundary(), loose, device.threads());
    find_barriers(device, hulls, near, {}, Stops(out), out.object_of_primitive, out.objects, {},
                  false);
    return out;
}

// Objects of the scene that carry a primitive.
std::vector<std::int32_t> carriers(const ObjectStage& stage, const Scene& scene,
                                   std::int32_t primitive) {
    std::vector<std::int32_t> out;
    for (const graph::Carrying& carrying : stage.contacts.carriers_of(primitive)) {
        const auto p = static_cast<std::size_t>(carrying.supporter);
        if (carrying.supporter >= 0 && p < scene.primitives.size())
            out.push_back(scene.primitives[p].object);
    }
    sort_unique(out);
    return out;
}

}  // namespace

std::vector<Appeared> judge_bodies(device::Device& device, const ParseResult& scene,
                                   std::span<const std::vector<Place>> bodies,
                                   const ParseOptions& options) {
    if (bodies.empty()) return {};
    const SolidScene all = whole_scene(*scene.solids, bodies),
                     near = near_scene(*scene.solids, bodies);
    const ObjectStage stage =
        stage_of(device, near, FloorHeights(*scene.solids), bodies.size(), options);
    const std::vector<safety::RiskObject> at_risk = risk_objects(stage.objects),
                                          weaker = safety::at_end(at_risk, -1);
    const safety::Surroundings around =
        surroundings_of(all, stage.object_of_primitive, stage.bodies);
    std::vector<safety::Category> category(at_risk.size());
    std::vector<std::map<std::string, double>> risk_J(at_risk.size()), fall_chance = risk_J;
    for (const safety::DisturbanceKind* kind : safety::acting_kinds(options)) {
        const safety::Disturbance field = kind->field(device, around, at_risk, options);
        const std::vector<safety::Risk> risks = safety::risk(field, at_risk),
                                        most = safety::risk_if(field, weaker);
        for (std::size_t o = 0; o < at_risk.size(); ++o) {
            risk_J[o][kind->name] = risks[o].mean_J;
            fall_chance[o][kind->name] = risks[o].chance;
            category[o] = std::max(
                {category[o], safety::category(risks[o], 1), safety::category(most[o], 1)});
        }
    }
    const vdb::VoxelFrame& frame = scene.voxels->frame();
    std::vector<Appeared> out;
    for (std::size_t n = 0; n < bodies.size(); ++n) {
        const Body& body = stage.objects[n + 1];
        if (!body.seen_enough()) continue;
        Appeared to;
        to.middle_m = frame.input_of(body.box.middle_m);
        to.size_m = body.box.size_m;
        to.mass_kg = body.candidate.body.mass_kg;
        to.mass_error_kg = body.mass_error_kg();
        to.stands_on = carriers(stage, scene.scene,
                                static_cast<std::int32_t>(all.primitives() - bodies.size() + n));
        to.barrier_J = body.instability.barrier_J;
        to.barrier_error_J = body.barrier_error_J;
        to.release_J = body.instability.release_J;
        to.mode = physics::to_string(body.instability.mode);
        to.risk_J = std::move(risk_J[n + 1]);
        to.fall_chance = std::move(fall_chance[n + 1]);
        if (!to.risk_J.empty()) to.unsafety_category = safety::to_string(category[n + 1]);
        out.push_back(std::move(to));
    }
    return out;
}

}  // namespace topple::live
