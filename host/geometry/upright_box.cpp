// SPDX-License-Identifier: MIT
#include "geometry/upright_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/ranked.h"
#include "geometry/fourfold.h"

namespace topple::geometry {
namespace {

// Thinner is a partition, lower a step; longer a row of what is built in.
constexpr double thinnest_m = 0.12, lowest_m = 0.3, longest_m = 1.4;
// How far off the floor seen surface may begin: of castors, plinths and what nobody saw.
constexpr double off_floor_m = 0.15;
// What lies so near a face is of it; spacings of samples, where these are far apart.
constexpr double face_m = 0.03, face_spacings = 0.75;
// Of what was seen, how much lies on the faces; of a face that counts as seen, how much was.
constexpr double least_on_faces = 0.85, least_seen_of_face = 0.4;
// Which way a sample looks for its face, and how far sides are off right angles, degrees.
constexpr double facing_cos = 0.7, side_degrees = 12;
constexpr int peak_degrees = 3;

// The direction that the sides face, modulo a right angle; where there are none, any.
double azimuth_of_sides(const SurfaceSamples& s, const PrimitiveShape& p) {
    constexpr double radians = std::numbers::pi / 180;
    FourfoldHistogram sides;
    std::vector<double> degrees;
    for (std::size_t n = p.first; n < p.last; ++n) {
        if (std::abs(s.nz[n]) >= 0.5F) continue;
        degrees.push_back(double{std::atan2(s.ny[n], s.nx[n])} / radians + 360);
        sides.add(degrees.back(), 1);
    }
    const double peak = sides.peak(peak_degrees).bin + 0.5;
    double sum = 0, count = 0;
    for (const double d : degrees) {
        const double off = d - peak - 90 * std::round((d - peak) / 90);
        if (std::abs(off) > side_degrees) continue;
        sum += off;
        ++count;
    }
    return (peak + (count > 0 ? sum / count : 0)) * radians;
}

// From where to where it reaches, without the outermost hundredths.
struct Reach {
    double low = 0, high = 0;
    explicit Reach(std::vector<double> at) {
        low = quantile(at, 0.01);
        high = quantile(at, 0.99);
    }
    double length() const { return high - low; }
};

}  // namespace

bool is_upright_box(const SurfaceSamples& s, const PrimitiveShape& p, double floor_m) {
    constexpr std::size_t least_samples = 30;
    if (p.samples() < least_samples || p.low[2] > floor_m + off_floor_m) return false;
    const double azimuth = azimuth_of_sides(s, p), c = std::cos(azimuth), sine = std::sin(azimuth);
    std::array<std::vector<double>, 3> at;
    for (std::size_t n = p.first; n < p.last; ++n) {
        at[0].push_back(c * s.x[n] + sine * s.y[n]);
        at[1].push_back(c * s.y[n] - sine * s.x[n]);
        at[2].push_back(s.z[n]);
    }
    const std::array<Reach, 3> reach{Reach(at[0]), Reach(at[1]), Reach(at[2])};
    const double width = reach[0].length(), depth = reach[1].length(),
                 height = reach[2].high - floor_m;
    if (std::min(width, depth) < thinnest_m || std::max(width, depth) > longest_m ||
        height < lowest_m)
        return false;
    const double near = std::max(face_m, face_spacings * s.spacing_m);
    std::array<double, 5> seen{};  // by face: both ends of the first two axes, the top
    std::size_t on_faces = 0;
    for (std::size_t n = p.first; n < p.last; ++n) {
        const std::size_t k = n - p.first;
        const std::array<double, 2> normal{c * s.nx[n] + sine * s.ny[n],
                                           c * s.ny[n] - sine * s.nx[n]};
        bool on = std::abs(at[2][k] - reach[2].high) < near;
        seen[4] += on && s.nz[n] > facing_cos;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const bool high = std::abs(at[axis][k] - reach[axis].high) < near,
                       low = std::abs(at[axis][k] - reach[axis].low) < near;
            seen[2 * axis] += low && -normal[axis] > facing_cos;
            seen[2 * axis + 1] += high && normal[axis] > facing_cos;
            on = on || high || low;
        }
        on_faces += on;
    }
    if (static_cast<double>(on_faces) < least_on_faces * static_cast<double>(p.samples()))
        return false;
    const double each_m2 = p.area_m2 / static_cast<double>(p.samples());
    const std::array<double, 5> area{depth * height, depth * height, width * height, width * height,
                                     width * depth};
    const auto is_seen = [&](std::size_t face) {
        return seen[face] * each_m2 >= least_seen_of_face * area[face];
    };
    return is_seen(4) && is_seen(0) + is_seen(1) + is_seen(2) + is_seen(3) >= 3;
}

}  // namespace topple::geometry
