// SPDX-License-Identifier: MIT
#pragma once

#include "perf/standing_objects.h"
#include "standard.h"
#include "topple/input.h"

// What a rigid-body simulator (Bullet, in double precision) makes of bodies of voxels. Metres,
// kilograms, seconds; z up; gravity 9.80665 m/s^2. It shares nothing with topple's physics.
namespace topple::simulation {

// The body without what of each part reaches below the level on which most of it rests, where that
// is less than half of it: a rough underside interlocks with its support, which would be left out.
LooseBody without_rough_underside(LooseBody body, std::span<const Cell> fixed);

// One body among fixed cells, all in contact as solids. Fixed cells that a part's hull cuts are
// left out: a hull covers the hollows of its part with what stands in them, and evens out a rough
// side, so that it would begin deep in its surroundings and be thrown out of them.
class Simulation {
  public:
    // step_s: what is shaken or pushed for seconds takes short ones. In steps of 1/240 s a quarter
    // of the falls in earthquakes come out otherwise than in steps of 1/960 s.
    Simulation(const LooseBody& body, std::span<const Cell> fixed, double friction,
               double step_s = 1.0 / 240);
    ~Simulation();
    Simulation(Simulation&&) noexcept;

    double mass_kg() const;
    double height_m() const;  // of the body above its centre of mass, at the beginning
    // A blow at a point relative to the centre of mass, in N s, and the kinetic energy that it
    // gives to the body at rest if nothing touches it.
    void push(const Vec3& impulse_Ns, const Vec3& at_m = {});
    double energy_J(const Vec3& impulse_Ns, const Vec3& at_m = {}) const;
    // Goes on until it has moved by more than `far_m`, at most.
    void run(double seconds, double far_m);
    // Goes on until the centre of mass is lower by more than `by_m` than it was, which is told, or
    // until the body has come to rest.
    bool sinks(double seconds, double by_m);
    // What acts on the body while it goes on: an acceleration as by a ground that moves the other
    // way, and a force at a point of the body, given where that is at the beginning, relative to
    // the centre of mass.
    struct Load {
        std::function<Vec3(double seconds)> thrown_m_s2;
        Vec3 force_N{}, at_m{};
    };
    // Whether it falls within that time: its centre of mass comes to be lower by more than `by_m`.
    // What has gone `far_m` on its level does not, nor what
    // comes to rest where nothing shakes.
    bool falls(double seconds, double by_m, double far_m, const Load& load);
    Vec3 moved_m() const;  // of the centre of mass, since the beginning
    void reset();          // to the beginning

  private:
    struct World;
    std::unique_ptr<World> world_;
    double step_s_;
};

}  // namespace topple::simulation
