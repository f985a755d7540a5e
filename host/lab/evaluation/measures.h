// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "lab/rooms/measured_shapes.h"
#include "topple/parse.h"

// What a parse says of the mass and the barrier of single things that are known exactly, from
// their points to the scene's figures.
namespace topple::evaluation {

struct TrueMeasures {
    double mass_kg = 0;
    Vec3 center_of_mass_m{};  // room frame
    // Of tipping on a level support, by the exact landscape of its hull.
    double barrier_J = 0;
};
TrueMeasures true_measures(const scenes::World& world, std::int32_t object, double density_kg_m3);

struct MeasureScore {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    std::string name;
    std::uint64_t seed = 0;
    double mass = none, barrier = none;  // over the true ones; NaN: the thing was not found
    double center_m = none;              // from the true centre of mass
    // How many of its own standard errors each is off.
    double mass_sigmas = none, barrier_sigmas = none;
    std::array<double, 3> center_sigmas{none, none, none};  // along each axis of the input
    double parse_s = 0;
};

struct MeasureOptions {
    bool frames = false;       // the depth camera's noisy frames, not clean points
    double spacing_m = 0.004;  // of clean points
    ParseOptions parse;
};

// Puts the shape where the seed says, scans, parses and compares. The object judged is the movable
// one that has most of the shape's points; none where that has less than half of them, or where
// more than half of its own are not the shape's.
MeasureScore measure(const scenes::MeasuredShape& shape, std::uint64_t seed,
                     const MeasureOptions& options);

// A row for each shape, means over seeds, and how the ratios are spread over all.
std::string measures_table(const std::vector<MeasureScore>& scores);
std::string measures_csv(const std::vector<MeasureScore>& scores);

}  // namespace topple::evaluation
