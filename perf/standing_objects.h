// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "physics/part_hulls.h"
#include "physics/sliding.h"
#include "topple/kernels/device.h"

// Things of voxels that stand, for barriers to be timed on and to be judged by simulators.
namespace topple::simulation {

using Cell = std::array<std::int32_t, 3>;  // spans [i, i + 1] * voxel_m per axis

// One rigid body that is the convex hulls of its parts, its mass that of its cells.
struct LooseBody {
    double voxel_m = 0, density_kg_m3 = 700;
    std::vector<std::vector<Cell>> parts;
};

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
    physics::PartHulls hulls_;
    std::vector<physics::Candidate> candidates_;
};

}  // namespace topple::simulation
