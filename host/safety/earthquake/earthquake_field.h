// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "safety/disturbances.h"
#include "safety/fields.h"
#include "topple/input.h"

namespace topple::safety {

struct EarthquakeOptions {
    std::uint64_t seed = 1;
    double pga_m_s2 = 3.0;  // median over the events
    double spread = 0.5;    // standard deviation of the logarithm of an event's peak
    unsigned events = 64;
    // A recorded ground motion, instead of made-up ones; it is the same for every seed.
    std::optional<Accelerogram> record;
    // What things stand on shakes so many times as strongly as the ground, whose peaks these are.
    double floor_amplification = 1;
    std::optional<HazardCurve> hazard;
    bool over_space = false;  // Disturbance::space is wanted
};

// Ground motion (5.1.1): made-up records (made_up_records.h) of random direction and peak, or a
// record, once from each of the 16 directions. One event is one of these.
//
// Each object is a rigid body that rocks, slides, or both, in two planes (ground_motion.h,
// kernel rocking). W is the larger of m g times the rise of its centre in its largest turn, and of
// mu m g times its largest slip. So that risk counts what falls, W is at least the barrier if the
// object overturns, or slides as far as the end of its support that way (slide_distance_m at
// least), and else stays below it. What nothing holds falls in any. Upper floors shake more
// (RiskObject::floor_shakes). Over space: at the cells on which things stand, v^2 / 2 of the peak
// velocity v there, joules per kilogram, which all ways of shaking share alike.
Disturbance earthquake_field(device::Device& device, const Surroundings& surroundings,
                             std::span<const RiskObject> objects, const EarthquakeOptions& options);

const DisturbanceKind& earthquake_kind();

}  // namespace topple::safety
