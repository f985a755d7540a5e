// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "topple/input.h"

// What a rigid-body simulator (Bullet, in double precision) makes of bodies of voxels. Metres,
// kilograms, seconds; z up; gravity 9.80665 m/s^2. It shares nothing with topple's physics.
namespace topple::simulation {

using Cell = std::array<std::int32_t, 3>;  // spans [i, i + 1] * voxel_m per axis

// One rigid body that is the convex hulls of its parts, its mass that of its cells.
struct LooseBody {
    double voxel_m = 0, density_kg_m3 = 700;
    std::vector<std::vector<Cell>> parts;
};

// One body among fixed cells, all in contact as solids. Fixed cells that a part's hull cuts are
// left out: a hull covers the hollows of its part with what stands in them, and evens out a rough
// side, so that it would begin deep in its surroundings and be thrown out of them.
class Simulation {
  public:
    Simulation(const LooseBody& body, std::span<const Cell> fixed, double friction);
    ~Simulation();
    Simulation(Simulation&&) noexcept;

    double mass_kg() const;
    // A blow to the centre of mass, in N s.
    void push(const Vec3& impulse_Ns);
    // Goes on until it has moved by more than `far_m`, at most.
    void run(double seconds, double far_m);
    Vec3 moved_m() const;  // of the centre of mass, since the beginning

  private:
    struct World;
    std::unique_ptr<World> world_;
};

}  // namespace topple::simulation
