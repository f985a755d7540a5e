// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "geometry/surfel_steps.h"

namespace topple::geometry {
namespace {

float normals_dot(const Surfels& s, std::size_t a, std::size_t b) {
    return s.nx[a] * s.nx[b] + s.ny[a] * s.ny[b] + s.nz[a] * s.nz[b];
}

void flip(Surfels& s, std::size_t i) {
    s.nx[i] = -s.nx[i];
    s.ny[i] = -s.ny[i];
    s.nz[i] = -s.nz[i];
}

// Spreads the sign from `seed` over its connected piece; returns the piece. Edges wait in buckets
// by parallelism, so that the order is fixed and linear in time.
std::vector<std::uint32_t> spread_sign(Surfels& s, std::uint32_t seed, std::vector<bool>& done) {
    constexpr std::size_t buckets = 64;
    std::array<std::vector<std::array<std::uint32_t, 2>>, buckets> waiting;
    std::size_t top = 0;
    std::vector<std::uint32_t> piece;
    const auto reach = [&](std::uint32_t i) {
        done[i] = true;
        piece.push_back(i);
        for (const std::uint32_t j : s.around(i)) {
            if (done[j]) continue;
            const float parallel = std::min(std::abs(normals_dot(s, i, j)), 1.0f);
            const auto bucket = static_cast<std::size_t>(parallel * (buckets - 1));
            waiting[bucket].push_back({i, j});
            top = std::max(top, bucket);
        }
    };
    reach(seed);
    for (;;) {
        while (top > 0 && waiting[top].empty()) --top;
        if (waiting[top].empty()) return piece;
        const auto [from, to] = waiting[top].back();
        waiting[top].pop_back();
        if (done[to]) continue;
        if (normals_dot(s, from, to) < 0) flip(s, to);
        reach(to);
    }
}

void orient_by_neighbours(Surfels& s) {
    std::array<double, 3> middle{};
    for (std::size_t i = 0; i < s.size(); ++i) {
        middle[0] += s.x[i];
        middle[1] += s.y[i];
        middle[2] += s.z[i];
    }
    for (double& v : middle) v /= static_cast<double>(std::max<std::size_t>(s.size(), 1));
    std::vector<bool> done(s.size());
    for (std::size_t seed = 0; seed < s.size(); ++seed) {
        if (done[seed]) continue;
        const auto piece = spread_sign(s, static_cast<std::uint32_t>(seed), done);
        double inward = 0;
        for (const std::uint32_t i : piece) {
            inward += s.nx[i] * (middle[0] - s.x[i]) + s.ny[i] * (middle[1] - s.y[i]) +
                      s.nz[i] * (middle[2] - s.z[i]);
        }
        if (inward < 0) {
            for (const std::uint32_t i : piece) flip(s, i);
        }
    }
}

}  // namespace

SensorSides::SensorSides(const CloudView& cloud, std::span<const Vec3> viewpoints,
                         std::span<const std::uint32_t> viewpoint_of_point)
    : cloud_(cloud),
      viewpoints_(viewpoints),
      viewpoint_of_point_(viewpoint_of_point),
      known_(!viewpoints.empty() || !cloud.nx.empty()) {}

std::array<double, 3> SensorSides::way(std::size_t i) const {
    if (viewpoints_.empty()) return {cloud_.nx[i], cloud_.ny[i], cloud_.nz[i]};
    const Vec3& eye = viewpoints_[viewpoint_of_point_.empty() ? 0 : viewpoint_of_point_[i]];
    return {eye[0] - cloud_.x[i], eye[1] - cloud_.y[i], eye[2] - cloud_.z[i]};
}

std::array<float, 3> SensorSides::towards(std::size_t i) const {
    // Sums of up to 2^33 multiples of 2^-20 are exact.
    constexpr double steps = 0x1p20;
    const std::array<double, 3> d = way(i);
    const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    std::array<float, 3> out{};
    if (!(length > 0) || !std::isfinite(length)) return out;
    for (std::size_t a = 0; a < 3; ++a)
        out[a] = static_cast<float>(std::round(d[a] / length * steps) / steps);
    return out;
}

Orientation sensor_side(const Surfels& s, const SensorSides& sides, ThreadPool& threads) {
    Orientation result;
    if (!sides.known()) return result;
    for (auto& axis : result.towards) axis.assign(s.size(), 0.0);
    // The directions in parallel, their sums after that; block by block, since all of them would
    // take as much memory as the cloud.
    constexpr std::size_t block = 1 << 16;
    const std::size_t points = s.of_point.size();
    std::vector<std::array<float, 3>> unit(std::min(block, points));
    for (std::size_t begin = 0; begin < points; begin += block) {
        const std::size_t size = std::min(block, points - begin);
        threads.each(size, size / 16 + 1,
                     [&](std::size_t k) { unit[k] = sides.towards(begin + k); });
        for (std::size_t k = 0; k < size; ++k) {
            const std::uint32_t at = s.of_point[begin + k];
            for (std::size_t a = 0; a < 3; ++a) result.towards[a][at] += unit[k][a];
        }
    }
    return result;
}

void orient(Surfels& s, const Orientation& orientation) {
    if (orientation.towards[0].empty()) {
        orient_by_neighbours(s);
        return;
    }
    for (std::size_t i = 0; i < s.size(); ++i) {
        const auto& t = orientation.towards;
        if (s.nx[i] * t[0][i] + s.ny[i] * t[1][i] + s.nz[i] * t[2][i] < 0) flip(s, i);
    }
}

}  // namespace topple::geometry
