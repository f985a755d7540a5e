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
    double pga_m_s2 = 3.0;           // median over the events
    double spread = 0.5;             // standard deviation of the logarithm of an event's peak
    double dominant_period_s = 0.5;  // a half-cycle is a rectangular pulse of half this length
    unsigned events = 64;
    // A recorded ground motion, instead of pulses; it is the same for every seed.
    std::optional<Accelerogram> record;
};

// Ground motion that throws objects in a horizontal direction (5.1.1): rectangular pulses of random
// direction and peak a, lasting t = period / 2, or a record, once in each of the 16 directions. One
// event is one pulse, or the record in one direction.
//
// With half base b(dir) and height h of the centre of mass, an object with b / h < mu rocks once
// a > g b / h; one with b / h >= mu slides once a > mu g. W is the largest energy of that motion:
//   - rocking about an edge, of a record: potential and kinetic (shaking.h); of a pulse,
//   linearised,
//         W = E_tip 2 eta (eta - 1) (cosh(p t) - 1),  eta = a h / (g b),  p^2 = g R / (k^2 + R^2),
//     R^2 = b^2 + h^2, k the radius of gyration: for a block, W >= E_tip is Housner's (1963)
//     condition for overturning;
//   - sliding by s relative to the support: W = mu m g s; of a pulse, s = (a - mu g) a t^2 / (2 mu
//   g).
// So that risk counts what falls, W is at least the barrier if the object overturns, or slides as
// far as the end of its support that way (slide_distance_m at least), and else stays below it.
Disturbance earthquake_field(device::Device& device, const Surroundings& surroundings,
                             std::span<const RiskObject> objects, double friction,
                             const EarthquakeOptions& options);

// The work of one pulse of `acceleration` m/s^2 and `duration_s`, or of a record, on one object.
struct Profile;
double pulse_work(const RiskObject& object, const Profile& body, double acceleration,
                  double friction, double duration_s);
double record_work(const RiskObject& object, const Profile& body, const Accelerogram& record,
                   double friction);

const DisturbanceKind& earthquake_kind();

}  // namespace topple::safety
