// SPDX-License-Identifier: MIT
#include "objects/object_masses.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "objects/density_prior.h"
#include "physics/closed_furniture.h"
#include "physics/hollow_body.h"
#include "physics/repeated_objects.h"

namespace topple {
namespace {

Table<ObjectId, double> sums(double physics::MassProperties::*of, ObjectOf object_of,
                             TableView<PrimitiveId, physics::MassProperties> bodies,
                             std::size_t objects) {
    Table<ObjectId, double> out(objects, 0);
    for (std::size_t p = 0; p < bodies.size(); ++p) out[object_of(p)] += bodies[p].*of;
    return out;
}

std::vector<std::int32_t> members(ObjectOf object_of, ObjectId object) {
    std::vector<std::int32_t> out;
    for (std::size_t p = 0; p < object_of.primitives(); ++p)
        if (object_of(p) == object) out.push_back(static_cast<std::int32_t>(p));
    return out;
}

// What is closed by some ways that voxels may fall, and solid by others, weighs what it does in the
// mean, and is off by what two such ways differ in the mean of squares, which covers both. A share
// of how far closed and solid are apart.
double two_ways_apart(double closed_ways) {
    return std::sqrt(2 * closed_ways * (1 - closed_ways));
}

physics::BodyError scaled(physics::BodyError error, double factor) {
    error.mass_kg *= factor;
    for (double& e : error.center_m) e *= factor;
    return error;
}

// Makes the shell that is known of one object.
void hollow_out(const SolidScene& solids, std::span<const std::int32_t> primitives, double wall_m,
                double density_kg_m3, Table<PrimitiveId, physics::MassProperties>& bodies,
                physics::Symmetric& inertia) {
    const physics::HollowBody shell = physics::hollow_body(solids, primitives, wall_m);
    for (std::size_t n = 0; n < primitives.size(); ++n) {
        physics::MassProperties& body = bodies[primitives[n]];
        body.mass_kg = density_kg_m3 * shell.volume_m3[n];
        if (shell.volume_m3[n] > 0) body.center = shell.center[n];
    }
    for (std::size_t e = 0; e < inertia.size(); ++e)
        inertia[e] = density_kg_m3 * shell.inertia_m5[e];
}

// Scales the densities of one object to its mass.
void weigh(std::span<const std::int32_t> primitives, double mass_kg,
           Table<PrimitiveId, physics::MassProperties>& bodies, physics::Symmetric& inertia) {
    double before = 0;
    for (const std::int32_t p : primitives) before += bodies[p].mass_kg;
    if (!(before > 0)) return;
    for (const std::int32_t p : primitives) bodies[p].mass_kg *= mass_kg / before;
    for (double& value : inertia) value *= mass_kg / before;
}

}  // namespace

const char* to_string(MassModel model) {
    constexpr const char* names[] = {"solid", "closed", "hollow", "kind"};
    return names[static_cast<std::size_t>(model)];
}

ObjectMasses weigh_objects(const SolidScene& solids, ObjectOf object_of,
                           TableView<ObjectId, KnownMass> known, std::int32_t grounded,
                           const ParseOptions& options,
                           Table<PrimitiveId, physics::MassProperties>& bodies) {
    const std::size_t objects = known.size();
    ObjectMasses out;
    out.objects.resize(objects);
    Table<ObjectId, double> density(objects, options.density_kg_m3), inertia_density = density;
    const Table<ObjectId, double> volume =
        sums(&physics::MassProperties::volume_m3, object_of, bodies, objects);
    auto looks = physics::furniture_looks(solids, object_of, volume);
    for (std::size_t o = 0; o < objects; ++o)
        if (static_cast<std::int32_t>(o) == grounded || known[o].wall_m) looks[o] = {};
    const physics::Repeated alike = physics::find_repeated(looks);
    for (std::size_t o = 0; o < objects; ++o) {
        const ThingKind* kind =
            options.materials ? named_kind(*options.materials, known[o].name) : nullptr;
        physics::Friction& friction = out.objects[o].friction;
        friction.coefficient = known[o].friction.value_or(
            kind && kind->friction > 0 ? kind->friction : options.friction);
        if (!known[o].friction)
            friction.error = physics::unknown_friction_share * friction.coefficient;
    }
    for (std::size_t o = 0; options.materials && o < objects; ++o) {
        if (static_cast<std::int32_t>(o) == grounded || known[o].wall_m) continue;
        const Vec3 size_m{looks[o].box_m[0], looks[o].box_m[1], looks[o].height_m};
        const DensityPrior prior =
            density_prior(*options.materials, known[o].name, size_m, looks[o].fill);
        density[o] = inertia_density[o] = prior.median_kg_m3;
        out.objects[o].model = MassModel::kind;
        out.objects[o].density_error_share = prior.error_share();
    }
    if (options.contents_kg_m3) {
        const std::vector<physics::ClosedOdds> odds = physics::closed_odds(looks, alike);
        for (std::size_t o = 0; o < objects; ++o) {
            const double share = odds[o].closed_ways;
            if (share == 0) continue;
            const physics::ClosedBody body = physics::closed_body(
                looks[o], volume[o], options.density_kg_m3, *options.contents_kg_m3);
            out.objects[o].drawers = physics::drawers_of(looks[o], odds[o].probability, body);
            if (out.objects[o].model == MassModel::kind) continue;  // which knows what it holds
            const double less_kg_m3 = options.density_kg_m3 - body.density_kg_m3;
            if (share > 0.5) out.objects[o].model = MassModel::closed;
            physics::BodyError& error = out.objects[o].contents_error;
            error = scaled(body.error, share);
            error.mass_kg =
                std::hypot(error.mass_kg, two_ways_apart(share) * less_kg_m3 * volume[o]);
            density[o] -= share * less_kg_m3;
            inertia_density[o] += share * (body.inertia_density_kg_m3 - inertia_density[o]);
        }
    }
    for (std::size_t p = 0; p < bodies.size(); ++p) {
        out.density_kg_m3.push_back(density[object_of(p)]);
        bodies[p].mass_kg = bodies[p].volume_m3 * out.density_kg_m3.back();
    }
    out.moments = physics::second_moments(solids.cells(), static_cast<std::int32_t>(bodies.size()),
                                          solids.boundary());
    const std::vector<physics::Symmetric> inertia =
        physics::inertia_of_objects(out.moments, bodies, object_of, inertia_density);
    for (std::size_t o = 0; o < objects; ++o) {
        ObjectMasses::Object& object = out.objects[o];
        object.inertia = inertia[o];
        object.weighed = known[o].mass_kg.has_value();
        if (known[o].wall_m) object.model = MassModel::hollow;
        if (!known[o].wall_m && !object.weighed) continue;
        const std::vector<std::int32_t> primitives = members(object_of, o);
        if (known[o].wall_m)
            hollow_out(solids, primitives, *known[o].wall_m, options.density_kg_m3, bodies,
                       object.inertia);
        if (object.weighed) weigh(primitives, *known[o].mass_kg, bodies, object.inertia);
        for (const std::int32_t p : primitives) out.density_kg_m3[p] = bodies[p].density_kg_m3();
    }
    const Table<ObjectId, double> mass =
        sums(&physics::MassProperties::mass_kg, object_of, bodies, objects);
    for (std::size_t o = 0; o < objects; ++o)
        out.objects[o].alike_error_kg = physics::error_among_alike_kg(mass, alike[o], o);
    return out;
}

}  // namespace topple
