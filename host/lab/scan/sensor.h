// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lab/random.h"
#include "lab/solids/ray_caster.h"

// What a depth and colour camera sees, first as it is and then as a cheap sensor gives it.
namespace topple::scenes {

using Colour = std::array<std::uint8_t, 3>;

// Light from above and one side, as a factor for surfaces of a normal, and grain.
struct Light {
    Vec3 direction{0.3, 0.2, 0.93};
    double ambient = 0.55, grain = 6, exposure = 1;

    Colour shade(const Part& part, const Vec3& normal, const Vec3& at, Random& random) const;
};

// One image without any error. Depth is along the camera's axis, 0 where no surface is.
struct ExactView {
    std::vector<float> depth, cosine;  // m; of the angle between the ray and the normal
    std::vector<std::int32_t> part;
    std::vector<Colour> colour;
};
ExactView look(const RayCaster& caster, const Intrinsics& k, const Mat4& camera_to_room,
               const Light& light, Random random);

// Defects of a sensor. Standard deviation of depth: axial_m + growth * (z - 0.4)^2.
struct Sensor {
    double least_m = 0.4, most_m = 5;
    double axial_m = 0.0008, growth = 0.0016;
    double step = 0.0014;      // of inverse depth, 1/m; 0: no steps
    double ragged_px = 1.6;    // how far outlines are displaced
    double lost_edges = 0.75;  // share of readings lost where depth jumps
    double flying = 0;         // share of the others there that lie between both sides
    double grazing = 0.28;     // cosine of incidence below which readings get lost
    double blobs = 2;          // standard deviations beyond which a patch gives no reading
    double specks = 0.01;      // share of readings lost anywhere
    std::vector<float> bend;   // by pixel: what depth is off, over its square, 1/m; or empty
};
// Three of five are bent: by some centimetres at 4 m, as uncalibrated ones are.
Sensor any_sensor(const Intrinsics& k, Random& random);

// Depth in metres, 0 for no reading.
std::vector<float> rough_depth(const ExactView& view, const Intrinsics& k, const Sensor& sensor,
                               Random random);

}  // namespace topple::scenes
