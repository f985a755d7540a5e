// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "device/device.h"
#include "physics/sliding.h"
#include "simulation/simulation.h"

// The least energy that topples things or pushes them off what they stand on, by topple's S(W) and
// by blows in the simulator.
namespace topple::simulation {

inline constexpr double friction = 0.3;

// A body that stands on a table or on the floor; both are of the same world of voxels.
struct StandingObject {
    std::string name;
    LooseBody body;
    std::vector<Cell> fixed;  // what it stands on, and the floor below that
};
// Boxes, columns, cylinders, L and T shapes, arches, steps, lamps, chairs, tables, things that lean
// out to a side or over the table's edge: twelve kinds in turn, their sizes and places random.
std::vector<StandingObject> standing_objects(std::uint64_t seed, std::size_t count);

// The same objects as a parse has them before it asks for barriers.
class StandingScene {
  public:
    // From their voxels: mass, contacts, support functions.
    StandingScene(device::Device& device, const std::vector<StandingObject>& objects);
    // S(W) of all objects in one batch.
    std::vector<physics::Instability> instability() const;

  private:
    device::Device& device_;
    SolidCells cells_;
    std::vector<std::int32_t> object_of_primitive_;  // 0: what is fixed
    std::optional<physics::SupportTable> table_;
    std::vector<physics::Candidate> candidates_;
};

// The least energy of a horizontal blow in any of 16 directions, at the height of the centre of
// mass, of the top or halfway, after which the centre of mass comes to be lower by half a voxel
// than before. The energy is what the blow would give to the free body, m v^2 / 2 and I w^2 / 2
// together, to 2 %; infinite where no blow suffices.
double weakest_blow_J(const StandingObject& object);
// The same of blows in one horizontal direction, unit.
double weakest_blow_J(const StandingObject& object, const Vec3& direction);

}  // namespace topple::simulation
