// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "safety/fields.h"
#include "safety/human/human_field.h"

namespace topple::safety {

// A recorded body in the frame of its walk: x ahead, y to the left, z above the floor, metres. Its
// velocities are those in a room where it walks at the speed of the options.
struct PosedBody {
    std::array<std::vector<Vec3>, body_joint_count> place, velocity;  // by joint, then by frame
    std::size_t frames = 0;
    bool has(BodyJoint joint) const { return !place[static_cast<std::size_t>(joint)].empty(); }
    const Vec3& at(BodyJoint joint, std::size_t f) const {
        return place[static_cast<std::size_t>(joint)][f];
    }
    const Vec3& moves(BodyJoint joint, std::size_t f) const {
        return velocity[static_cast<std::size_t>(joint)][f];
    }
};

// Positions are averaged over 0.08 s, against noise; its way as a whole, averaged over 0.5 s, is
// taken out. It faces across its shoulders, hips, elbows or wrists, from the right ones to the
// left, whichever of these were recorded first. Throws Error(input) naming the source where that,
// its place or its height can't be told.
PosedBody posed_body(const BodyMotion& motion, const HumanOptions& options);

// Throws Error(input): "<source of the motion>: <what>".
[[noreturn]] void refuse_motion(const BodyMotion& motion, const std::string& what);

}  // namespace topple::safety
