// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "child/message.h"

// What MuJoCo makes of an export: all objects free at once, and nobody touches them.
namespace topple::mujoco {

// What stands stays within these.
inline constexpr double stays_m = 0.01, stays_deg = 2;

// A body that is free to move, from the start on.
struct Motion {
    std::string body;
    double moved_m = 0, turned_deg = 0;  // the most that it was away from its place and its pose
    double fastest_m_s = 0;              // its centre's
    bool stays() const { return moved_m < stays_m && turned_deg < stays_deg; }
};

inline constexpr const char* became_unstable = "it became unstable";

struct Settled {
    std::string problem;          // why it could not be run; empty: it was
    std::string cut_short;        // why it ended before its time: became_unstable, say
    std::string version;          // of MuJoCo, "2.2.2"
    std::uint64_t contacts = 0;   // at the start
    double deepest_m = 0;         // of them
    std::uint64_t left_out = 0;   // steps in which there was no room for all contacts
    double simulated_s = 0;       // so long it ran
    double wall_s = 0;            // and that took
    std::vector<Motion> motions;  // in the file's order
};

// As topple-mujoco answers. The numbers that are read may be anything, as they may in a run; throws
// child::BadAnswer.
void write_settled(const Settled& settled);
Settled read_settled(const child::Answer& answer);

}  // namespace topple::mujoco
