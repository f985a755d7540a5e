// SPDX-License-Identifier: MIT
#pragma once

#include "simulation/simulation.h"

// The least energy that topples things or pushes them off what they stand on, by topple's S(W) and
// by blows in the simulator.
namespace topple::simulation {

// The least energy of a horizontal blow in any of 16 directions, at the height of the centre of
// mass, of the top or halfway, after which the centre of mass comes to be lower by half a voxel
// than before. The energy is what the blow would give to the free body, m v^2 / 2 and I w^2 / 2
// together, to 2 %; infinite where no blow suffices.
double weakest_blow_J(const StandingObject& object);
// The same of blows in one horizontal direction, unit.
double weakest_blow_J(const StandingObject& object, const Vec3& direction);

}  // namespace topple::simulation
