// SPDX-License-Identifier: MIT
#include "export/named_bodies.h"

#include <Eigen/Dense>
#include <cmath>

#include "core/field_rules.h"
#include "core/vectors.h"
#include "topple/error.h"

namespace topple::exports {
namespace {

// What is wrong with a body; empty: nothing.
std::string fault_of(const Body& body) {
    if (!rules::finite(body.center_m)) return "its centre of mass is not known";
    for (const ConvexPart& part : body.parts)
        if (!rules::finite(part.corner)) return "its shape is not finite";
    if (body.fixed) return {};
    if (!has_mass(body)) return "it has no mass";
    if (!rules::finite(body.inertia_kg_m2)) return "its inertia is not known";
    if (!has_inertia(body)) return "its inertia is not positive";
    return {};
}

Shape shape_in(const Body& body, const ConvexPart& part) {
    Shape out = shape_of(part);
    std::visit(
        [&](auto& shape) {
            if constexpr (requires { shape.center; })
                shape.center = minus(shape.center, body.center_m);
        },
        out);
    return out;
}

}  // namespace

std::string body_name(const Body& body, std::size_t place) {
    return body.object >= 0 ? "object_" + std::to_string(body.object)
                            : "pad_" + std::to_string(place);
}

bool has_mass(const Body& body) {
    return body.mass_kg > 0 && std::isfinite(body.mass_kg);
}

bool has_inertia(const Body& body) {
    if (!has_mass(body) || !rules::finite(body.inertia_kg_m2)) return false;
    const Eigen::Matrix3d inertia(body.inertia_kg_m2.data());
    return inertia.llt().info() == Eigen::Success;
}

std::vector<NamedBody> named_bodies(const SimScene& scene) {
    std::vector<NamedBody> out;
    for (std::size_t n = 0; n < scene.bodies.size(); ++n) {
        const Body& body = scene.bodies[n];
        if (body.parts.empty()) continue;
        NamedBody& to = out.emplace_back();
        to.name = body_name(body, n);
        const std::string fault = fault_of(body);
        if (!fault.empty()) throw Error(ErrorKind::input, to.name + " can't be exported: " + fault);
        to.body = &body;
        to.friction = body.friction_or(scene.friction);
        for (const ConvexPart& part : body.parts)
            to.parts.push_back({to.name + "_part_" + std::to_string(to.parts.size()), &part,
                                shape_in(body, part)});
        for (const JointedFront& front : scene.fronts) {
            if (front.body != n) continue;
            NamedFront& named = to.fronts.emplace_back(&front, front.boxes);
            for (Box& box : named.boxes) box.center = minus(box.center, front.center_m);
        }
    }
    return out;
}

}  // namespace topple::exports
