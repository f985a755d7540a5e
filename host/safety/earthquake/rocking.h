// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "topple/input.h"
#include "topple/kernels/device.h"

// What ground motion does to rigid bodies, seen from the side (kernel rocking). Everything is
// relative to the ground, which throws a body `ahead` while its acceleration is positive: it moves
// the other way itself.
namespace topple::safety {

// The body: how far its base reaches from under the centre of mass each way, how high that is, and
// its radius of gyration about the centre. Metres.
struct Profile {
    double ahead_m = 0, behind_m = 0, height_m = 0, gyration_m = 0;
    // How far the support goes on under the centre each way, at least.
    double support_ahead_m = 0, support_behind_m = 0;
    double friction = 0.3;  // coefficient
    double least_base_m() const { return ahead_m < behind_m ? ahead_m : behind_m; }
    double slenderness() const { return least_base_m() / height_m; }  // where it rocks, over g
};

// A record acts on a body: its components, of which the level two add up, are multiplied. Of the
// friction it has a share, as the rest holds the body against what shakes it across.
struct Shaking {
    std::uint32_t body = 0, record = 0;  // indices
    double along = 0, across = 0, up = 0;
    double grip = 1;
};

// How far it came, each way: the largest turn about an edge, and the largest slip over the ground.
struct Motion {
    float turned_ahead = 0, turned_behind = 0;  // radians
    float slid_ahead_m = 0, slid_behind_m = 0;
    bool overturned_ahead() const;  // that turn came to 90 degrees
    bool overturned_behind() const;
    bool slid_off(const Profile& body) const;  // a slip came to where its support ends
    bool overturned() const { return overturned_ahead() || overturned_behind(); }
    // Largest rise of its centre times g, J/kg: of the edge that it turned about.
    double raised_J_kg(const Profile& body) const;
};

// Everything is integrated in steps of the record's own, or so many times shorter that they are at
// most 0.05 / p of the quickest of its class of bodies, p^2 = g R / (k^2 + R^2), R^2 = b^2 + h^2.
// Motions are sensitive, as in nature: tests/kernels says of how many the end differs from that of
// finer steps. Bodies without a height stay as they are.
std::vector<Motion> shake(device::Device& device, std::span<const Profile> bodies,
                          std::span<const Accelerogram> records, std::span<const Shaking> shakings);

}  // namespace topple::safety
