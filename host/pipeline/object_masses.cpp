// SPDX-License-Identifier: MIT
#include "pipeline/object_masses.h"

#include <cstddef>

#include "physics/closed_furniture.h"

namespace topple {
namespace {

std::vector<double> volumes(std::span<const std::int32_t> object_of_primitive,
                            std::span<const physics::Body> bodies, std::size_t objects) {
    std::vector<double> out(objects, 0);
    for (std::size_t p = 0; p < bodies.size(); ++p)
        out[static_cast<std::size_t>(object_of_primitive[p])] += bodies[p].volume_m3;
    return out;
}

}  // namespace

ObjectMasses weigh_objects(const SolidScene& solids,
                           std::span<const std::int32_t> object_of_primitive, std::size_t objects,
                           std::int32_t grounded, const ParseOptions& options,
                           std::vector<physics::Body>& bodies) {
    ObjectMasses out;
    out.closed.assign(objects, false);
    out.contents_error.resize(objects);
    std::vector<double> density(objects, options.density_kg_m3), inertia_density = density;
    if (options.contents_kg_m3) {
        const std::vector<double> volume = volumes(object_of_primitive, bodies, objects);
        const auto looks = physics::furniture_looks(solids, object_of_primitive, volume);
        for (std::size_t o = 0; o < objects; ++o) {
            if (static_cast<std::int32_t>(o) == grounded ||
                physics::probability_closed(looks[o]) <= 0.5)
                continue;
            const physics::ClosedBody body = physics::closed_body(
                looks[o], volume[o], options.density_kg_m3, *options.contents_kg_m3);
            out.closed[o] = true;
            out.contents_error[o] = body.error;
            density[o] = body.density_kg_m3;
            inertia_density[o] = body.inertia_density_kg_m3;
        }
    }
    for (std::size_t p = 0; p < bodies.size(); ++p) {
        out.density_kg_m3.push_back(density[static_cast<std::size_t>(object_of_primitive[p])]);
        bodies[p].mass_kg = bodies[p].volume_m3 * out.density_kg_m3.back();
    }
    const std::vector<physics::Symmetric> moments = physics::second_moments(
        solids.cells(), static_cast<std::int32_t>(bodies.size()), solids.boundary());
    out.inertia =
        physics::inertia_of_objects(moments, bodies, object_of_primitive, inertia_density);
    return out;
}

}  // namespace topple
