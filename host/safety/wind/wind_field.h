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

struct WindOptions {
    double speed_m_s = 12;
    double air_density_kg_m3 = 1.2, drag_coefficient = 1.3;
    double shelter_m =
        1.0;  // length of an obstacle's lee: what stands closer behind it gets no wind
    // Where it comes from, degrees from +y towards +x, which is clockwise from north seen from
    // above; none: from each of the 16 directions.
    std::optional<double> from_deg;
    bool over_space = false;  // Disturbance::space is wanted
};

// A gale of one speed, from one direction or from each of 16, alike in all of the space (5.1.1).
// F = rho C_d A v^2 / 2 acts on the exposed frontal area A at the height h of its centre. With m g
// b(dir) / h the force that tips the object and mu m g the force that slides it,
//     W = F D,  D = E / F_threshold
// where E is the barrier that way below the threshold (so W rises as v^2 and reaches the barrier at
// the threshold, where the object moves), and above it the energy of that very motion, if larger.
// What slides before it tips, b > mu h_p, tips on the way where F (h_p - h) > m g (b - mu h), which
// is the balance about its edge as it speeds up; else it falls where its support ends that way.
// One event is one gale, from one of its directions at random.
Disturbance wind_field(device::Device& device, const Surroundings& surroundings,
                       std::span<const RiskObject> objects, const WindOptions& options);

// The work of one gale on one object (see above): area_m2 of it is exposed, centred at
// pressure_height_m above its base; its centre of mass is height_m above it.
struct WindLoad {
    double area_m2 = 0, pressure_height_m = 0;
    double half_base_m = 0, height_m = 0;
    Vec3 way{};  // that it blows
};
double wind_force(const WindLoad& load, const WindOptions& options);  // newtons
double wind_work(const RiskObject& object, const WindLoad& load, const WindOptions& options);

// By object, the least speed of a gust that tips it, m/s, over all directions, if it does not slide
// before; NaN: nothing of it stands in the wind, or it is grounded. options: their speed
// is not asked for.
std::vector<double> tipping_gusts(device::Device& device, const Surroundings& surroundings,
                                  std::span<const RiskObject> objects, const WindOptions& options);

// The exposed frontal area of one object in wind that blows along the unit vector `way` (x, y): by
// layers of voxels, what the wind's lines meet first of the object, unless another solid stands
// less than shelter_m in front of it. `cells`: the object's, ascending.
class Columns;
struct Frontage {
    double area_m2 = 0, center_m = 0;  // centre: height in the grid frame
    std::vector<std::uint32_t> cells;  // exposed, ascending
};
Frontage wind_frontage(const SolidCells& solid, const Columns& columns,
                       std::span<const std::uint32_t> cells, const std::array<double, 2>& way,
                       double shelter_m);

const DisturbanceKind& wind_kind();

}  // namespace topple::safety
