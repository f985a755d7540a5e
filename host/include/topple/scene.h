// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "topple/input.h"

// The result of a parse. Lengths in metres, masses in kilograms, energies in joules; every
// coordinate and direction is in the input's frame. Ids count from 0; -1 means unassigned.
namespace topple {

// A convex-ish solid part: one or more surface regions merged by geometry (paper, 2.1.2).
struct Primitive {
    std::int32_t id = -1;
    std::int32_t object = -1;
    std::string model;  // "plane" | "quadric" | "merged"
    std::uint64_t points = 0;
    std::uint64_t solid_voxels = 0;
    double volume_m3 = 0;
    double mass_kg = 0;
    Vec3 center_of_mass_m{};
};

// One step of the instability curve S(W) (paper, Eq. 6).
struct InstabilityStep {
    double W_J = 0;  // energy absorbed
    double S_J = 0;  // the largest release that this much energy can set free
};

// A set of primitives fixed to one another: one rigid body.
struct Object {
    std::int32_t id = -1;
    std::vector<std::int32_t> primitives;
    bool grounded = false;  // holds the floor, or is fixed to what does
    double mass_kg = 0;
    Vec3 center_of_mass_m{};
    double barrier_J = 0;  // least energy that moves it out of its basin
    // What a voxel more or less in its shape or support changes in the barrier: M g x voxel size.
    double barrier_error_J = 0;
    double release_J = 0;       // what it can release then
    std::string mode = "none";  // "tip" | "slide" | "none"
    Vec3 direction{};           // weakest horizontal direction, unit, or zero for "none"
    std::vector<InstabilityStep> instability;
    std::map<std::string, double> risk_J;  // by disturbance, joules per event
    double unsafety = 1;                   // 1 (safest) to 10, by risk, over the scene's objects
};

// Whether the barrier can't be told from 0.
inline bool barrier_within_error(const Object& o) {
    return !o.grounded && o.barrier_J <= o.barrier_error_J;
}

// Two primitives that touch.
struct Contact {
    std::int32_t a = -1, b = -1;
    double area_m2 = 0;
    Vec3 normal{};  // unit, from a to b
    std::string
        relation;  // "fixed" (one object) | "support" (a carries b, or b carries a) | "adjacent"
    double probability = 0;  // that the joint is fixed, over the sampler's states
};

// One object that carries another.
struct Support {
    std::int32_t supporter = -1, supported = -1;
    double area_m2 = 0;
};

// Point of the parsed cloud, one array per field, input order (for frames: the fused cloud).
struct ScenePoints {
    std::vector<float> x, y, z, nx, ny, nz;
    std::vector<std::int32_t> primitive, object;
    std::vector<std::int32_t> region{};  // smooth piece of surface that primitives are merged of
};

// Solid voxels at their centres.
struct SolidVoxels {
    std::vector<float> x, y, z;
    std::vector<std::int32_t> primitive, object;
    std::vector<std::uint8_t> state;  // 0 seen surface, 1 completed
};

// A disturbance field on the walkable or exposed space: where, which way and how strongly a
// disturbance acts. One array per field.
struct FieldSamples {
    std::vector<float> x, y, z;     // metres
    std::vector<float> vx, vy, vz;  // mean direction times strength (m/s, or m/s^2 for earthquakes)
    std::vector<float> density;     // visits per event, or exposure in 0..1
};

struct Scene {
    std::string source, topple_version, backend, device;
    std::uint64_t seed = 1;
    double voxel_size_m = 0;
    Vec3 up{0, 0, 1};
    // "given" | "manhattan" | "dominant-plane" | "upright-surfaces" | "assumed"
    std::string up_method;
    bool manhattan_found = false;
    Mat4 manhattan_from_input{};
    double density_kg_m3 = 700, friction = 0.3;
    std::vector<Primitive> primitives;
    std::vector<Object> objects;
    std::vector<Contact> contacts;
    std::vector<Support> supports;
    std::vector<std::pair<std::string, double>> timings_s;  // in the order of the stages
    std::vector<double> swc_energy;  // best energy after each sweep of the sampler (paper, Fig. 7d)
    std::vector<std::string> notes;  // what the reader of the result should know, in sentences
    ScenePoints points;
    SolidVoxels solid;
    std::map<std::string, FieldSamples> fields;  // by disturbance
};

}  // namespace topple
