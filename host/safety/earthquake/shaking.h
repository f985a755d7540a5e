// SPDX-License-Identifier: MIT
#pragma once

#include "topple/input.h"

// What recorded ground motion does to a rigid body on level ground, seen from the side. Everything
// is relative to the ground, which throws the body `ahead` while its acceleration is positive: it
// moves the other way itself.
namespace topple::safety {

// The body: how far its base reaches from under the centre of mass each way, how high that is, and
// its radius of gyration about the centre. Metres.
struct Profile {
    double ahead_m = 0, behind_m = 0, height_m = 0, gyration_m = 0;
    // How far the support goes on under the centre each way, at least.
    double support_ahead_m = 0, support_behind_m = 0;
    // A side over which it can rock: it does so before friction lets it slide.
    bool rocks_ahead(double friction) const { return ahead_m < friction * height_m; }
    bool rocks_behind(double friction) const { return behind_m < friction * height_m; }
};

// Rocking about the edges of the base (Housner 1963), for any rigid body. At the angle q about one
// edge, with the half base b there, alpha = atan(b / h), R^2 = b^2 + h^2, k the radius of gyration,
//     q'' = p^2 ((a / g) cos(alpha - q) - sin(alpha - q)),  p^2 = g R / (k^2 + R^2),
// which is 3 g / 4 R for a rectangle; a counts towards that edge. It starts where |a| > g b / h.
// When it comes down, the motion goes on about the other edge (b'): angular momentum about that is
// kept, so that the speed falls by (k^2 + h^2 - b b') / (k^2 + h^2 + b'^2), which is 1 - 1.5 sin^2
// alpha for a rectangle. A swing shorter than 0.001 / p counts as rest.
struct Rocking {
    bool overturns = false;  // q reaches 90 degrees, also after the record's end
    double energy_J_kg = 0;  // the largest of the motion, potential and kinetic
};
// Integrated by velocity Verlet, with impacts and starts found within a step, in steps of at most
// `step` / p and of the record's own. The motion is sensitive: of bodies that shaking just rocks,
// one in 75 falls with these steps and not with five times as many, or the reverse.
Rocking rock(const Profile& body, const Accelerogram& record, double friction, double step = 0.01);

// Sliding (Newmark 1965): where |a| > mu g and the body does not rock that way, it slides until
// friction, mu g, has stopped it. Exact for accelerations that are straight between samples.
struct Sliding {
    double ahead_m = 0, behind_m = 0;  // furthest from where it stood, each way
};
Sliding slide(const Profile& body, const Accelerogram& record, double friction);

}  // namespace topple::safety
