// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/device.h"
#include "physics/bodies.h"
#include "physics/toppling.h"
#include "safety/directions.h"
#include "topple/input.h"
#include "topple/motion.h"
#include "topple/scene.h"

// Disturbance fields (paper, 5.1) and the risk they bring (Eq. 7). Grid frame: metres, z up.
namespace topple::safety {

// An object as this stage sees it.
struct RiskObject {
    std::int32_t id = -1;
    bool grounded = false;  // or held by what was not seen: no risk is reckoned
    double mass_kg = 0;
    double barrier_J = 0;
    double height_m = 0;                 // of the object itself
    double base_width_m = 0;             // least width of its support polygon
    double slide_distance_m = -1;        // shortest way to where its support ends; -1: no edge
    double drop_m = 0;                   // fall from there
    std::vector<InstabilityStep> curve;  // S(W)
    // S(W) by direction and height; null: the curve, whatever the way.
    std::shared_ptr<const physics::Toppling> toppling;
    // The points that hold it up, as their convex hull (metres, counter-clockwise). Where given, it
    // tells how far the object reaches each way; else base_width_m stands for all ways.
    std::vector<std::array<double, 2>> support_polygon;
};

// Where things are, for the fields: object of each solid cell, -1 for none.
struct Surroundings {
    const SolidCells* cells = nullptr;
    std::vector<std::int32_t> object;      // of each cell
    std::vector<bool> is_floor_primitive;  // by primitive: horizontal, lowest, walkable
    // By primitive, for where the centres of mass are; empty: the same everywhere.
    std::vector<double> density_kg_m3 = {};
};

struct HumanOptions {
    std::uint64_t seed = 1;
    unsigned paths = 500;
    double cell_m = 0.05;  // of the walkable map and of the field
    double body_radius_m = 0.20;
    double body_height_m = 1.8;
    double step_height_m = 0.05;   // obstacles up to this height don't stop a walker
    double largest_hole_m = 0.30;  // holes in the scanned floor up to this width are bridged
    double body_mass_kg = 70;
    double walking_speed_m_s = 1.3;
    double wander_m = 0.20;    // how far walkers stray sideways from their path, at most
    double restitution = 0.5;  // of a body's part that strikes a thing
    // How the bodies of walkers move; none: as in the table of body_parts.h.
    std::shared_ptr<const BodyMotion> motion;
};
struct WindOptions {
    double speed_m_s = 12;
    double air_density_kg_m3 = 1.2, drag_coefficient = 1.3;
    double friction = 0.3;
    double shelter_m =
        1.0;  // length of an obstacle's lee: what stands closer behind it gets no wind
    // Where it comes from, degrees from +y towards +x, which is clockwise from north seen from
    // above; none: from each of the 16 directions.
    std::optional<double> from_deg;
};
struct EarthquakeOptions {
    std::uint64_t seed = 1;
    double pga_m_s2 = 3.0;           // median over the events
    double spread = 0.5;             // standard deviation of the logarithm of an event's peak
    double dominant_period_s = 0.5;  // a half-cycle is a rectangular pulse of half this length
    unsigned events = 64;
    // A recorded ground motion, instead of pulses; it is the same for every seed.
    std::optional<Accelerogram> record;
};

// One field: samples for the report, and each object's distribution of work: p(W) as weighted
// samples.
struct WorkSample {
    double W_J = 0, probability = 0;  // per event
    Vec3 direction{};
    // Of a blow, above the object's base; NaN: a steady push, or shaking.
    double height_m = std::numeric_limits<double>::quiet_NaN();
};
// A horizontal force, and how high above the object's base it acts.
struct Push {
    double force_N = 0, height_m = 0;
};

struct Disturbance {
    std::string name;                           // "human" | "wind" | "earthquake"
    FieldSamples samples;                       // grid frame, at most max_samples
    std::vector<std::vector<WorkSample>> work;  // by object, as in `objects`; none if grounded
    std::size_t draws = 1;                      // independent events that `work` was found from
    std::vector<float> exposure;                // of each solid cell: strikes per walk (human), or
                                                // share of the directions it is open to (wind) or
                                                // 1 (earthquake); 0 for grounded objects
    Walks walks;                                // of the human field
    // By object: its work if its barrier, curve and edges were others, as where it stood elsewhere,
    // just as exposed. Empty for the human field, whose exposure is another there
    // (HumanField::work_at).
    std::vector<std::function<std::vector<WorkSample>(const RiskObject&)>> response;
    std::vector<Push> strongest;     // by object: of all its events
    std::vector<std::string> notes;  // e.g. no walkable floor was found
};

inline constexpr std::size_t max_samples = 4000;  // arrows per field, for the report
inline constexpr unsigned max_shown_paths = 100;  // walks whose way the report draws

// People who walk between random places (5.1.2): 500 shortest paths give the primary motion, a
// table of body parts (body_parts.h) the secondary; their convolution (kernels disturbance_reach,
// disturbance) the passes of each part through each cell per walk. W is what a thing of mass M
// takes over of m v^2 / 2 of the part (5.2): (1 + e)^2 m M / (m + M)^2 of it. One event is one
// walk. Nothing walkable, no object: an empty field, and a note that says why.
Disturbance human_field(device::Device& device, const Surroundings& surroundings,
                        std::span<const RiskObject> objects, const HumanOptions& options);
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

// The work of one gale on one object (see above): area_m2 of it is exposed, centred at
// pressure_height_m above its base; its centre of mass is height_m above it.
struct WindLoad {
    double area_m2 = 0, pressure_height_m = 0;
    double half_base_m = 0, height_m = 0;
    Vec3 way{};  // that it blows
};
double wind_force(const WindLoad& load, const WindOptions& options);  // newtons
double wind_work(const RiskObject& object, const WindLoad& load, const WindOptions& options);

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

// The work of one pulse of `acceleration` m/s^2 and `duration_s`, or of a record, on one object.
struct Profile;
double pulse_work(const RiskObject& object, const Profile& body, double acceleration,
                  double friction, double duration_s);
double record_work(const RiskObject& object, const Profile& body, const Accelerogram& record,
                   double friction);

// S(W): the last step of the curve whose W_J is at most W; 0 below the first.
double instability(std::span<const InstabilityStep> curve, double W_J);

// The same of what comes from one side, at one height.
double instability(const RiskObject& object, const WorkSample& event);
// Least work of a steady push towards `way` from which that is above 0; infinite where there is
// none; barrier_J where no directions are known.
double push_barrier_J(const RiskObject& object, const Vec3& way);
// Straight on to where its support ends; infinite where it does not. Where no directions are known,
// slide_distance_m, and `support_m` at least.
double slide_towards_m(const RiskObject& object, const Vec3& way, double support_m);

// What one disturbance means to one object.
struct Risk {
    double mean_J = 0;    // R = sum over p(W, way, z) S(W, way, z) (Eq. 7), joules per event
    double spread_J = 0;  // its standard error: sqrt((sum p S^2 - R^2) / draws)
    double chance = 0;    // per event, that it falls: sum of p where S > 0
};
Risk risk_of(std::span<const WorkSample> work, const RiskObject& object, std::size_t draws);
// For each object; all 0 for grounded ones.
std::vector<Risk> risk(const Disturbance& disturbance, std::span<const RiskObject> objects);

// 1 (safest) to 10 over the scene's objects, by their largest risk r over the disturbances (one
// vector of risks per disturbance): 1 + 9 log(1 + 999 r / r_max) / log(1000). Risks spread over
// decades: the logarithm keeps three of them apart. No risk is 1, the largest 10; a scene without
// risk is all 1.
std::vector<double> unsafety(std::span<const std::vector<Risk>> risks);

}  // namespace topple::safety
