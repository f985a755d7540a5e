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

#include "physics/bodies.h"
#include "physics/closed_furniture.h"
#include "physics/directions.h"
#include "physics/toppling.h"
#include "safety/fall_zone.h"
#include "topple/input.h"
#include "topple/kernels/device.h"
#include "topple/motion.h"
#include "topple/scene.h"
#include "topple/space_field.h"

// Disturbance fields (paper, 5.1) and the risk they bring (Eq. 7). Grid frame: metres, z up.
namespace topple::safety {

// An object as this stage sees it. Its id is its place in the list of all.
struct RiskObject {
    bool grounded = false;  // or held by what was not seen: no risk is reckoned
    double mass_kg = 0;
    double barrier_J = 0;
    // Of what carries it, grid frame; NaN: of its lowest voxel. Heights of pushes and blows count
    // from there.
    double base_m = std::numeric_limits<double>::quiet_NaN();
    // Of mass, grid frame; nothing: that of its voxels.
    std::optional<Vec3> center{};
    double height_m = 0;                 // of its top
    double base_width_m = 0;             // least width of its support polygon
    double base_error_share = 0;         // one standard error of b / h, as a share of it
    double slide_distance_m = -1;        // shortest way to where its support ends; -1: no edge
    std::vector<InstabilityStep> curve;  // S(W)
    // S(W) by direction and height; null: the curve, whatever the way.
    std::shared_ptr<const physics::Toppling> toppling;
    double barrier_error_J = 0;       // one standard error
    bool slides = false;              // rather than that it tips
    physics::Drawers drawers;         // that people may pull out
    double friction = 0.3;            // coefficient, on what it stands on
    double friction_error_share = 0;  // one standard error of that, as a share of it
    double floor_shakes = 1;  // in earthquakes, so many times as strongly as the ground floor
    // Not as measured, but as at an end of that error (risk_error.h): the border of its support
    // lies so much further out, and the roots of its barriers are larger by so much.
    double border_shift_m = 0, root_shift = 0;
    // The points that hold it up, as their convex hull (metres, counter-clockwise). Where given, it
    // tells how far the object reaches each way; else base_width_m stands for all ways.
    std::vector<std::array<double, 2>> support_polygon;
};

// Where things are, for the fields: object of each solid cell, -1 for none.
struct Surroundings {
    const SolidCells* cells = nullptr;
    std::vector<std::int32_t> object;      // of each cell
    std::vector<bool> is_floor_primitive;  // by primitive: horizontal, lowest, walkable
    bool below_ceiling = false;            // most of a ceiling was scanned
    // By primitive, for where the centres of mass are; empty: the same everywhere.
    std::vector<double> density_kg_m3 = {};
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

// What one disturbance means to one object.
struct Risk {
    double mean_J = 0;    // R = sum over p(W, way, z) S(W, way, z) (Eq. 7), joules per event
    double spread_J = 0;  // its standard error: sqrt((sum p S^2 - R^2) / draws)
    double chance = 0;    // per event, that it falls: sum of p where S > 0
};
// Where else an object might stand: its cells moved by whole voxels.
struct Placement {
    std::size_t object = 0;
    std::int32_t di = 0, dj = 0;
    RiskObject there;  // how it falls from there
};

struct Disturbance {
    std::string name;                           // of its kind (disturbances.h)
    FieldSamples samples;                       // grid frame, at most max_samples
    std::vector<std::vector<WorkSample>> work;  // by object, as in `objects`; none if grounded
    std::size_t draws = 1;                      // independent events that `work` was found from
    std::vector<float> exposure;                // of each solid cell: strikes per walk (human), or
                                                // share of the directions it is open to (wind) or
                                                // 1 (earthquake); 0 for grounded objects
    Walks walks;                                // of the human field
    std::vector<Push> strongest;                // by object: of all its events
    std::vector<Fragility> fragility;           // by object, of an earthquake
    std::vector<std::vector<Hold>> holds;       // by object, of who reaches for it
    std::vector<double> gust_m_s;               // of wind from all sides: as tipping_gusts has it
    std::vector<std::string> notes;             // e.g. no walkable floor was found
    std::optional<SpaceField> space;            // grid frame; where it was asked for

    // By object: its work if its barrier, curve and edges were others, as where it stood elsewhere,
    // just as exposed. Empty where exposure is another there: then risk_at tells.
    std::vector<std::function<std::vector<WorkSample>(const RiskObject&)>> response;

    // What it can be asked as long as all that it was made from is there, as they refer to that.
    // Its work if objects stood more or less firmly, exposed as they are; empty: `response` tells.
    std::function<std::vector<std::vector<WorkSample>>(std::span<const RiskObject>)> work_if;
    // The risk of an object that stood elsewhere, by placement; empty: `response` tells.
    std::function<std::vector<Risk>(std::span<const Placement>)> risk_at;
    // By zone, the share of events in which somebody passes it; empty: it knows of nobody.
    std::function<std::vector<double>(std::span<const FallZone>)> passing_shares;
};

inline constexpr std::size_t max_samples = 4000;  // arrows per field, for the report

// S(W): the last step of the curve whose W_J is at most W; 0 below the first.
double instability(std::span<const InstabilityStep> curve, double W_J);

// The same of what comes from one side, at one height.
double instability(const RiskObject& object, const WorkSample& event);
// Least work of a steady push towards `way` from which that is above 0; infinite where there is
// none; barrier_J where no directions are known.
double push_barrier_J(const RiskObject& object, const Vec3& way);
// The same, but no more than it takes to turn it over the edge that lies that way, whether that
// releases anything or not: what upsets it brings so much, and not what it takes to go on from
// there.
double over_edge_J(const RiskObject& object, const Vec3& way);
// Straight on to where its support ends; infinite where it does not. Where no directions are known,
// slide_distance_m, and `support_m` at least.
double slide_towards_m(const RiskObject& object, const Vec3& way, double support_m);

// The mass that a level blow at that height meets of a thing that is free.
double met_mass_kg(const RiskObject& object, const Vec3& way, double height_m);
// The share of its kinetic energy that a mass which strikes a thing gives to it, by conservation of
// momentum: (1 + e)^2 m M / (m + M)^2, M being the mass that it meets.
double taken_share(const RiskObject& object, double mass_kg, const Vec3& way, double height_m,
                   double restitution);

Risk risk_of(std::span<const WorkSample> work, const RiskObject& object, std::size_t draws);

// For each object; all 0 for grounded ones.
std::vector<Risk> risk(const Disturbance& disturbance, std::span<const RiskObject> objects);

// The same if they stood as `changed` says.
std::vector<Risk> risk_if(const Disturbance& disturbance, std::span<const RiskObject> changed);

// 1 (safest) to 10 over the scene's objects, by their largest risk r over the disturbances (one
// vector of risks per disturbance): 1 + 9 log(1 + 999 r / r_max) / log(1000). Risks spread over
// decades: the logarithm keeps three of them apart. No risk is 1, the largest 10; a scene without
// risk is all 1.
std::vector<double> unsafety(std::span<const std::vector<Risk>> risks);

}  // namespace topple::safety
