// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/object_of.h"
#include "core/solid_scene.h"
#include "physics/bodies.h"
#include "physics/body_errors.h"
#include "physics/closed_furniture.h"
#include "physics/inertia.h"
#include "topple/parse.h"

namespace topple {

// What somebody knows of an object's mass, and of its friction.
struct KnownMass {
    std::optional<double> wall_m;    // it is a shell of that thickness
    std::optional<double> mass_kg;   // of all of it
    std::optional<double> friction;  // coefficient
    std::string name;                // what it is
};

enum class MassModel : std::uint8_t {
    solid,   // of the density that was given
    closed,  // furniture of boards around contents
    hollow,  // a shell, as somebody knows
    kind,    // as things of its name or size weigh
};
const char* to_string(MassModel model);

// What objects weigh.
struct ObjectMasses {
    struct Object {
        MassModel model = MassModel::solid;
        bool weighed = false;               // its mass is known
        physics::BodyError contents_error;  // 0 for solids
        double density_error_share = 0;     // of its mass: 0 where a density was given
        physics::Symmetric inertia{};       // about its centre of mass
        double alike_error_kg = 0;          // see physics/repeated_objects.h
        physics::Drawers drawers;           // grid frame
        physics::Friction friction;         // on what it stands on
    };
    Table<PrimitiveId, double> density_kg_m3;        // mass over volume
    Table<PrimitiveId, physics::Symmetric> moments;  // physics::second_moments
    Table<ObjectId, Object> objects;
};

// Gives `bodies`, of primitives at the density of the options, the masses that they have in their
// objects, and those of shells their centres. grounded: the object that is the room; -1: none.
ObjectMasses weigh_objects(const SolidScene& solids, ObjectOf object_of,
                           TableView<ObjectId, KnownMass> known, std::int32_t grounded,
                           const ParseOptions& options,
                           Table<PrimitiveId, physics::MassProperties>& bodies);

}  // namespace topple
