// SPDX-License-Identifier: MIT
#pragma once

#include <array>

// Secondary motion (paper, 5.1.2): how the parts of a walking body move relative to its path. The
// paper records it with a Kinect; this table takes it from published figures of level walking:
//   [D] Drillis & Contini 1966, as in Winter, Biomechanics and Motor Control of Human Movement,
//       4th ed. 2009, Fig. 4.1: heights and widths as fractions of the body's height H
//       (knee .285, hip .530, fingertip .377, wrist .485, elbow .630, shoulder .818; half widths
//       of shoulders .129, hips .096; foot length .152, breadth .055).
//   [W] Winter 2009, Table 4.1: segment masses as fractions of body mass (foot .0145, leg .0465,
//       thigh .100, hand .006, forearm .016, upper arm .028, pelvis .142).
//   [P] Perry & Burnfield, Gait Analysis, 2nd ed. 2010: 62 % stance and 38 % swing, stride 1.41 m,
//       step width 8 cm; the arm swings through about 32 degrees at the shoulder.
// Derived: the foot covers its stride in the swing alone, so it moves at 1 / 0.38 = 2.6 times the
// walker's speed for 38 % of the time; a hand 0.7 m below the shoulder that swings +-16 degrees
// once a stride moves 0.55 times the walker's speed forward, then backward, about its own mean
// of 1. The last row is an assumption: hands that reach out now and then, without which nobody
// would push a thing off a table's edge.
namespace topple::safety {

struct BodyPart {
    const char* name;
    double low, high;    // height above the floor, fractions of body height
    double reach;        // outermost distance from the path to either side, fraction of body height
    double back, front;  // reach behind and ahead of the body's centre, fractions of body height
    double speed;        // mean over the motion, relative to the walker's
    double mass;         // effective mass, fraction of body mass
    double share;        // of the passes in which the part moves so
};

inline constexpr std::array<BodyPart, 8> body_parts{{
    // name             low    high   reach  back   front  speed  mass   share   from
    {"foot", 0.000, 0.085, 0.050, 0.20, 0.25, 2.6, 0.038, 0.38},            // foot + half the leg
    {"knee", 0.085, 0.330, 0.070, 0.08, 0.15, 1.6, 0.097, 0.38},            // half of leg, thigh
    {"hip", 0.440, 0.580, 0.110, 0.07, 0.07, 1.0, 0.142, 1.00},             // pelvis
    {"hand forward", 0.377, 0.500, 0.160, -0.02, 0.20, 1.55, 0.010, 0.50},  // 0.7 kg, as in 5.2
    {"hand backward", 0.377, 0.500, 0.160, 0.15, -0.02, 0.45, 0.010, 0.50},
    {"elbow", 0.580, 0.680, 0.170, 0.10, 0.08, 1.1, 0.036, 1.00},          // arm less shoulder
    {"shoulder", 0.680, 0.880, 0.135, 0.07, 0.07, 1.0, 0.078, 1.00},       // arms' roots
    {"reaching hand", 0.400, 0.800, 0.280, 0.00, 0.20, 1.3, 0.022, 0.05},  // forearm + hand
}};
inline constexpr const BodyPart& hip = body_parts[2];
inline constexpr const BodyPart& reaching_hand = body_parts.back();

}  // namespace topple::safety
