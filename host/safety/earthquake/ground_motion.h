// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "safety/earthquake/rocking.h"
#include "safety/fields.h"
#include "safety/objects.h"

// Earthquakes and the objects that they shake.
namespace topple::safety {

// A record that comes from one direction: its first component counts along (dx, dy), its second a
// quarter turn to the left of that.
struct GroundEvent {
    std::uint32_t record = 0;
    double dx = 1, dy = 0;
    double scale = 1;  // of the record
};

// A record from each of the 16 directions.
std::vector<GroundEvent> from_all_ways(std::uint32_t record, double scale);

// An object, seen from the side in the plane in which its support ends nearest to below its centre,
// and in the one across that. It is taken to move in each of them by itself: what stands on a
// rectangle rocks over the edges of it. Of the friction each plane has the share that the shaking
// has in it, since what slides goes where it is shaken and is held as a whole.
struct ShakenObject {
    std::array<std::array<double, 2>, 2> way{};  // unit, which is ahead
    std::array<Profile, 2> body{};
    bool held = false;  // its centre is above its support, not beyond the end of it
    // Of b / h, by what is not known of the object, and of its friction.
    double base_error_share = 0, friction_error_share = 0;
    // Whether what overturns in a plane ahead, or behind, comes to rest lower there: it does not
    // fall where it only comes to lean on a wall, or lies as high as it stood.
    std::array<std::array<bool, 2>, 2> lower{{{true, true}, {true, true}}};
    double floor_shakes = 1;  // in all events, so many times as strongly
};
bool falls(const ShakenObject& object, std::size_t plane, const Motion& motion);
ShakenObject shaken_object(const RiskObject& object, const MassSpread& stance,
                           const Columns& columns);

// How an object moves in an event, in its two planes, and the correlation of what shakes it in
// them.
struct PlaneMotions {
    std::array<Motion, 2> in{};
    double together = 0;
};
// By object, then event. Where an object's index is not in `which`, there is none. endless:
// supports go on for ever, so that slips tell how far it would have gone.
using Motions = std::vector<std::vector<PlaneMotions>>;
Motions shake_objects(device::Device& device, std::span<const ShakenObject> objects,
                      std::span<const std::size_t> which, std::span<const Accelerogram> records,
                      std::span<const GroundEvent> events, bool endless);

// Chances of falling over the strength of shaking: each record scaled to peaks of 0.05 g and so on
// by factors of 1.4 up to 4 g, on the ground, from 16 directions; what the objects stand on shakes
// floor_amplification times as strongly. What upsets a body goes with b / h, so that the error of
// that adds to the dispersion that records and directions make, but for what slides first. What may
// slide is shaken once more on friction that lets nothing slide. By object, empty for those not in
// `which`, and for all where a record has no peak.
std::vector<Fragility> fragilities(device::Device& device, std::span<const ShakenObject> objects,
                                   std::span<const std::size_t> which,
                                   std::span<const Accelerogram> records,
                                   double floor_amplification, const HazardCurve* hazard);

}  // namespace topple::safety
