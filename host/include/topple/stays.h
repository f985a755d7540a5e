// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "topple/scene.h"

namespace topple {

// What is done to an object from outside, by an arm say, level and at one place of it. In the frame
// of the result's points, from which Scene::offset_m was taken off.
struct Touch {
    Vec3 place_m{};         // where it meets the object, metres
    Vec3 way{};             // where it goes: a level unit vector; zeros: to any side
    double force_N = 0;     // of a steady push, newtons
    double impulse_Ns = 0;  // of a bump, newton seconds: m v, and twice that where it bounces back
    double slack_m = 0.02;  // metres that the bump may set it sliding
};

// Whether the object stays where it is, to two standard errors of its mass and its foot, when it is
// touched so: the push and the bump each by itself. A foot that sensors did not see from all sides
// has an error of 40 % of its width (Overturning::push_error_N), so that a fifth of what would tip
// it (Overturning::push_N) is all that is sure.
//
// True says that
//   - the push is below what friction holds, and below what tips the object at that height, in each
//     of the directions next to `way` (DirectedBarrier::push_N, Overturning::slide_N);
//   - the bump is below the least that makes it fall there, at the heights next to it, too
//     (DirectedBarrier::blow_Ns). Where no fall was found, and that is infinite, it must bring less
//     than the barrier, by the energy that blow_J has: P^2 / (2 M) (1 + (z - h)^2 / k^2);
//   - it slides no farther than slack_m: v^2 / (2 mu g) with v = P / M, as if it did not turn.
// The ground, and what is fixed to it, stays whatever is done.
//
// False, where it may move, and where nobody knows:
//   - what holds it was not seen (seen_enough), or is likelier than not something else than was
//     found (rest_probability below 0.5); it hangs; its barrier is 0;
//   - it is likelier than not a piece of another object: ask about that one, its piece_of; or two
//     things in one (joint_probability below 0.5);
//   - the place is lower than what it stands on, or higher than the top of its box (box_middle_m,
//     size_m), by more than a voxel;
//   - one of these figures is NaN.
//
// True is no promise about what these figures leave out: that density and friction are as they were
// given, and what is solid to topple is not hollow; touches beside the line above its centre of
// mass, which turn it about the vertical, or at an edge where they press it down or lift it; many
// of them, one after the other; and what it carries or holds.
//
// Throws Error(usage) where an argument makes no sense: a place that is not finite, a way that is
// neither zero nor level (within 5 degrees) and of unit length (within 0.001), a force, an impulse
// or a slack that is less than 0 or not finite, an object that is none of the scene's.
bool stays(const Scene& scene, const Object& object, const Touch& touch);

// The same, and why not: "" where it stays, else a sentence: that it slides, tips or falls, by
// which figure; that its top is lower than the place; or what of it nobody knows.
std::string why_moves(const Scene& scene, const Object& object, const Touch& touch);

// The steady push at a place that way up to which it stays, newtons: 0 where nobody knows, infinite
// for what is grounded. Throws as stays() does.
double stays_up_to_N(const Scene& scene, const Object& object, const Vec3& place_m,
                     const Vec3& way = {});

// S(W) (paper, Eq. 6): the most that an object may set free once it is given W_J joules, whichever
// way, as Object::instability has it; 0 below its barrier, and for what is grounded. Throws
// Error(usage) for energies below 0 or NaN.
double released_J(const Object& object, double W_J);

}  // namespace topple
