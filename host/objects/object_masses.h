// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/solid_scene.h"
#include "physics/bodies.h"
#include "physics/body_errors.h"
#include "physics/inertia.h"
#include "topple/parse.h"

namespace topple {

// What somebody knows of an object's mass.
struct KnownMass {
    std::optional<double> wall_m;   // it is a shell of that thickness
    std::optional<double> mass_kg;  // of all of it
};

// What objects weigh: as solids of the density that was given, as closed furniture, or as is known.
struct ObjectMasses {
    std::vector<double> density_kg_m3;               // by primitive: mass over volume
    std::vector<bool> closed, hollow, weighed;       // by object
    std::vector<physics::BodyError> contents_error;  // by object, 0 for solids
    std::vector<physics::Symmetric> inertia;         // by object, about its centre of mass
    std::vector<double> alike_error_kg;              // by object: see physics/repeated_objects.h
};

// Gives `bodies`, of primitives at the density of the options, the masses that they have in their
// objects, and those of shells their centres. grounded: the object that is the room; -1: none.
// known: by object.
ObjectMasses weigh_objects(const SolidScene& solids,
                           std::span<const std::int32_t> object_of_primitive,
                           std::span<const KnownMass> known, std::int32_t grounded,
                           const ParseOptions& options,
                           std::vector<physics::MassProperties>& bodies);

}  // namespace topple
