// SPDX-License-Identifier: MIT
#include "geometry/face_surroundings.h"

#include <algorithm>

namespace topple::geometry {
namespace {

// Distances to the face within which floor counts and a cupboard's top, sides and wall, metres.
constexpr double floor_reach_m = 1.5, deep_m = 0.8;
// How far from where it should be something still counts, metres; and how near its normal is to
// what it should be, as a cosine.
constexpr double slack_m = 0.12, facing = 0.7;
// As many samples are enough.
constexpr std::size_t most_samples = 20'000;

}  // namespace

FaceSurroundings face_surroundings(const SurfaceSamples& s, const PrimitiveShape& face,
                                   double floor_m, const Eigen::Vector3d& out, double low_m,
                                   double high_m) {
    FaceSurroundings found;
    const std::size_t step = std::max<std::size_t>(1, s.size() / most_samples);
    const double slack = std::max(slack_m, 1.5 * s.spacing_m);
    for (std::size_t n = 0; n < s.size(); n += step) {
        const double ahead =
            out[0] * (s.x[n] - face.center[0]) + out[1] * (s.y[n] - face.center[1]);
        if (ahead < -floor_reach_m || ahead > floor_reach_m) continue;
        const double along = -out[1] * s.x[n] + out[0] * s.y[n];
        if (along < low_m - slack || along > high_m + slack) continue;
        const double z = s.z[n], facing_out = out[0] * s.nx[n] + out[1] * s.ny[n],
                     facing_along = -out[1] * s.nx[n] + out[0] * s.ny[n];
        const bool between = along > low_m && along<high_m, level = s.nz[n]> facing;
        if (level && between && z < floor_m + slack) {
            found.floor_behind += ahead < -slack;
            found.floor_before += ahead > slack;
        }
        if (ahead < -deep_m || ahead > slack / 2) continue;
        found.top_behind += level && between && std::abs(z - face.high[2]) < slack;
        found.wall_over += facing_out > facing && between && z > face.high[2] + slack;
        const bool high_end = facing_along > facing && along > high_m - slack,
                   low_end = facing_along < -facing && along < low_m + slack;
        found.ends_behind += (high_end || low_end) && ahead < -0.25 * slack && z > face.low[2] &&
                             z < face.high[2] + slack;
    }
    const double area = static_cast<double>(step) * s.spacing_m * s.spacing_m,
                 length = high_m - low_m + s.spacing_m,
                 height = face.high[2] - face.low[2] + s.spacing_m;
    found.floor_behind *= area / (length * floor_reach_m);
    found.floor_before *= area / (length * floor_reach_m);
    found.top_behind *= area / (length * deep_m);
    found.wall_over *= area / (length * deep_m);
    found.ends_behind *= area / (height * deep_m);
    return found;
}

}  // namespace topple::geometry
