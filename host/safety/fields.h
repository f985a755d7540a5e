// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "device/device.h"
#include "physics/bodies.h"
#include "topple/scene.h"

// Disturbance fields (paper, 5.1) and the risk they bring (Eq. 7). Grid frame: metres, z up.
namespace topple::safety {

// An object as this stage sees it.
struct RiskObject {
    std::int32_t id = -1;
    bool grounded = false;
    double mass_kg = 0;
    double barrier_J = 0;
    double height_m = 0;       // of the object itself
    double base_width_m = 0;   // least width of its support polygon
    double slide_distance_m = -1;  // shortest way to where its support ends; -1: no edge
    double drop_m = 0;             // fall from there
    std::vector<InstabilityStep> curve;  // S(W)
};

// Where things are, for the fields: object of each solid cell, -1 for none.
struct Surroundings {
    const physics::SolidCells* cells = nullptr;
    std::vector<std::int32_t> object;      // of each cell
    std::vector<bool> is_floor_primitive;  // by primitive: horizontal, lowest, walkable
};

struct HumanOptions {
    std::uint64_t seed = 1;
    unsigned paths = 500;
    double cell_m = 0.05;         // of the walkable map and of the field
    double body_radius_m = 0.20;
    double body_height_m = 1.8;
    double step_height_m = 0.05;  // obstacles up to this height don't stop a walker
};
struct WindOptions {
    double speed_m_s = 12;
    double air_density_kg_m3 = 1.2, drag_coefficient = 1.3;
};
struct EarthquakeOptions {
    std::uint64_t seed = 1;
    double pga_m_s2 = 3.0;
    unsigned events = 64;
};

// One field: samples for the report, and each object's distribution of work: p(W) as weighted samples.
struct WorkSample {
    double W_J = 0, probability = 0;  // per event
    Vec3 direction{};
};
struct Disturbance {
    std::string name;  // "human" | "wind" | "earthquake"
    FieldSamples samples;                           // grid frame
    std::vector<std::vector<WorkSample>> work;      // by object, as in `objects`
    std::vector<std::string> notes;                 // e.g. no walkable floor was found
};

Disturbance human_field(device::Device& device, const Surroundings& surroundings,
                        std::span<const RiskObject> objects, double friction, const HumanOptions& options);
Disturbance wind_field(device::Device& device, const Surroundings& surroundings,
                       std::span<const RiskObject> objects, const WindOptions& options);
Disturbance earthquake_field(device::Device& device, const Surroundings& surroundings,
                             std::span<const RiskObject> objects, double friction,
                             const EarthquakeOptions& options);

// R = sum over p(W) S(W) (Eq. 7), joules per event, for each object.
std::vector<double> risk(const Disturbance& disturbance, std::span<const RiskObject> objects);

// 1 (safest) to 10 over the scene's objects, by their largest risk.
std::vector<double> unsafety(std::span<const std::vector<double>> risks);

}  // namespace topple::safety
