// SPDX-License-Identifier: MIT
#include "safety/reach/hand_load.h"

#include <algorithm>
#include <cmath>

#include "physics/landscape.h"

namespace topple::safety {
namespace {

constexpr double leans_out_m = 0.158;  // who climbs, before the front: 0.52 ft

// Of a barrier, in spite of rounding where it is just reached.
double share_of(double barrier_J, double share) {
    return barrier_J * (share < 1 ? share : 1 + 1e-9);
}

}  // namespace

double hand_work_J(const RiskObject& object, const HandLoad& load) {
    const double weight = object.mass_kg * physics::gravity, rubs = object.friction * weight;
    const double towards = push_barrier_J(object, load.way);
    if (load.struck_kg > 0)
        return load.struck_kg * load.struck_m_s * load.struck_m_s / 2 *
               taken_share(object, load.struck_kg, load.way, load.height_m, 0);
    if (!std::isfinite(towards) || !(weight > 0)) return 0;
    const double moment = weight * load.half_base_m;
    const double over_edge = over_edge_J(object, load.way);
    if (load.climber_Nm > 0) return share_of(over_edge, moment > 0 ? load.climber_Nm / moment : 1);
    if (!(load.force_N > 0)) return 0;
    double most = 0;
    if (load.half_base_m <= object.friction * load.height_m)
        most = share_of(over_edge, moment > 0 ? load.force_N * load.height_m / moment : 1);
    const double distance = slide_towards_m(object, load.way, 0);
    if (std::isfinite(distance) && rubs > 0) {
        // What stays on is not given what it takes to tip it: a hand follows it.
        const double share = std::min(1.0, load.force_N / rubs) *
                             (distance > load.arm_m ? load.arm_m / distance : 1);
        const double goes = share < 1 ? towards : std::max(towards, rubs * distance);
        most = std::max(most, share_of(goes, share));
    }
    return most;
}

double blow_impulse_Ns(const RiskObject& object, const HandLoad& load) {
    const double met_kg = met_mass_kg(object, load.way, load.height_m);
    const double both = load.struck_kg + met_kg;
    return both > 0 ? load.struck_m_s * load.struck_kg * met_kg / both : 0;
}

double climber_moment_Nm(double mass_kg, double out_m) {
    return mass_kg * physics::gravity * (1.08 * out_m + leans_out_m);
}

Fall fall_against(double body_height_m, double body_mass_kg, double walking_m_s, double z_m,
                  double away_m) {
    const double inertia = body_mass_kg * body_height_m * body_height_m / 3;
    const double walked = 1.5 * walking_m_s / body_height_m;
    const double sunk = 1 - z_m / std::hypot(z_m, away_m);
    const double omega = std::sqrt(walked * walked + 3 * physics::gravity * sunk / body_height_m);
    return {std::min(body_mass_kg, inertia / (z_m * z_m)), omega * z_m};
}

}  // namespace topple::safety
