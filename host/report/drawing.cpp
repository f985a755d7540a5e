// SPDX-License-Identifier: MIT
#include "report/drawing.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "core/number_text.h"
#include "core/vectors.h"
#include "report/drawing_parts.h"

namespace topple::report {

std::string joules(double value) {
    if (std::abs(value) < 0.0005) return "0 J";
    return (std::abs(value) < 999.5 ? to_digits(value, 3) : to_places(value, 0)) + " J";
}

double lowest_of(const std::vector<Vec3>& corners, const Vec3& d) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const Vec3& v : corners) lowest = std::min(lowest, dot(v, d));
    return lowest;
}

std::vector<int> numbers_of(const Landscape& landscape) {
    constexpr std::size_t most = 10;
    std::vector<std::size_t> order(landscape.poses.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto depth = [&](std::size_t n) {
        return static_cast<std::int32_t>(n) == landscape.now
                   ? std::numeric_limits<double>::infinity()
                   : landscape.poses[n].joins_at_J - landscape.poses[n].energy_J;
    };
    std::ranges::stable_sort(order, std::greater<>(), depth);
    order.resize(std::min(order.size(), most));
    std::ranges::sort(order);
    std::vector<int> number(landscape.poses.size(), 0);
    int next = 1;
    for (const std::size_t n : order) number[n] = next++;
    return number;
}

Rgb8 colour_along(std::span<const Rgb8> colours, double share) {
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(colours.size() - 1);
    const std::size_t low = std::min(static_cast<std::size_t>(at), colours.size() - 2);
    Rgb8 out{};
    for (std::size_t c = 0; c < 3; ++c) {
        out[c] = static_cast<std::uint8_t>(std::lround(
            colours[low][c] + (colours[low + 1][c] - colours[low][c]) * (at - double(low))));
    }
    return out;
}

Rgb8 ramp_colour(double share) {
    return colour_along(ramp, share);
}

// Lambert's azimuthal equal-area projection of the whole sphere. A body leans away from where its
// former up direction d goes: to (-x, -y).
Point map_of(const Vec3& up) {
    const double level = std::hypot(up[0], up[1]);
    if (!(level > 1e-9)) return {0, up[2] > 0 ? 0.0 : -1.0};
    const double radius = std::sqrt(std::max(0.0, (1 - up[2]) / 2));
    return {-radius * up[0] / level, radius * up[1] / level};
}

Vec3 direction_at(const Point& place) {
    const double square = place[0] * place[0] + place[1] * place[1];
    const double level = 2 * std::sqrt(std::max(0.0, 1 - square));
    return {-level * place[0], level * place[1], 1 - 2 * square};
}

std::vector<Drawing> landscape_drawings(const Scene& scene, const Object& object) {
    std::vector<Drawing> out;
    if (object.grounded) return out;
    if (!object.instability.empty()) out.push_back(draw_curve(object));
    if (!object.landscape.hull_m.empty()) {
        out.push_back(draw_poses(scene, object));
        out.push_back(draw_tree(object));
    }
    if (object.landscape.places.side > 0) out.push_back(draw_places(object.landscape.places));
    return out;
}

}  // namespace topple::report
