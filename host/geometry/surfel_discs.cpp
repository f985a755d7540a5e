// SPDX-License-Identifier: MIT
#include "geometry/surfel_discs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vectors.h"

namespace topple::geometry {
namespace {

// Normals that differ by more are of two faces (cosine); so much of its radius a disc goes on
// beyond their edge, so that those of both faces overlap.
constexpr double one_face_cos = 0.8, edge_overlap = 0.15;
constexpr std::uint64_t disc_chunk = 1 << 12;  // handed to a thread at once

using Vec2 = std::array<double, 2>;

// Two unit vectors that stand on a unit normal and on one another.
std::array<Vec3, 2> tangents(const Vec3& n) {
    const std::size_t axis = std::abs(n[0]) < 0.5 ? 0 : 1;  // far from the normal
    Vec3 u{}, v{};
    const double length = std::sqrt(1 - n[axis] * n[axis]);
    for (std::size_t a = 0; a < 3; ++a) u[a] = ((a == axis) - n[a] * n[axis]) / length;
    for (std::size_t a = 0; a < 3; ++a)
        v[a] = n[(a + 1) % 3] * u[(a + 2) % 3] - n[(a + 2) % 3] * u[(a + 1) % 3];
    return {u, v};
}

// A convex polygon around the origin, cut down to one's side of the middle between it and others.
class VoronoiCell {
  public:
    explicit VoronoiCell(double half)
        : corners_{{-half, -half}, {half, -half}, {half, half}, {-half, half}} {}

    void cut(const Vec2& other) {
        const double square = other[0] * other[0] + other[1] * other[1];
        if (square <= 0) return;
        const auto beyond = [&](const Vec2& p) {
            return p[0] * other[0] + p[1] * other[1] - square / 2;
        };
        kept_.clear();
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            const Vec2 &a = corners_[i], &b = corners_[(i + 1) % corners_.size()];
            const double at_a = beyond(a), at_b = beyond(b);
            if (at_a <= 0) kept_.push_back(a);
            if ((at_a < 0) != (at_b < 0) && at_a != at_b) {
                const double t = at_a / (at_a - at_b);
                kept_.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])});
            }
        }
        corners_.swap(kept_);
    }

    // Of the corners within a distance the farthest one's distance.
    double farthest_within(double most) const {
        double farthest = 0;
        for (const Vec2& p : corners_) {
            const double distance = std::hypot(p[0], p[1]);
            if (distance <= most) farthest = std::max(farthest, distance);
        }
        return farthest;
    }

  private:
    std::vector<Vec2> corners_, kept_;
};

}  // namespace

std::vector<float> covering_radii(const Surfels& s, double gap_m, ThreadPool& pool) {
    const double least = radius_sides * std::sqrt(s.area_m2);
    std::vector<float> radii(s.size(), static_cast<float>(least));
    if (!(gap_m > least)) return radii;
    pool.each(s.size(), disc_chunk, [&](std::size_t i) {
        const Vec3 n{s.nx[i], s.ny[i], s.nz[i]};
        if (n == Vec3{}) return;
        const auto [u, v] = tangents(n);
        VoronoiCell cell(2 * gap_m);
        for (const std::uint32_t j : s.around(i)) {
            const Vec3 d{double{s.x[j]} - s.x[i], double{s.y[j]} - s.y[i], double{s.z[j]} - s.z[i]};
            const Vec2 along{dot(d, u), dot(d, v)};
            const double planar = std::hypot(along[0], along[1]);
            if (!(planar > 0)) continue;
            const double unfold = std::sqrt(dot(d, d)) / planar;
            cell.cut({unfold * along[0], unfold * along[1]});
        }
        radii[i] = static_cast<float>(std::max(least, cell.farthest_within(gap_m)));
    });
    return radii;
}

std::vector<DiscCuts> cuts_at_edges(const Surfels& s, std::span<const float> radii_m,
                                    ThreadPool& pool) {
    constexpr double other_way = 0.5;  // cosine, of two directions in which a disc ends
    std::vector<DiscCuts> cuts(s.size());
    pool.each(s.size(), disc_chunk, [&](std::size_t i) {
        const Vec3 n{s.nx[i], s.ny[i], s.nz[i]}, at{s.x[i], s.y[i], s.z[i]};
        if (n == Vec3{}) return;
        double nearest[2] = {radii_m[i], radii_m[i]};
        Vec3 towards[2]{};
        for (const std::uint32_t j : s.around(i)) {
            const Vec3 m{s.nx[j], s.ny[j], s.nz[j]};
            const double cosine = dot(n, m);
            if (m == Vec3{} || std::abs(cosine) > one_face_cos) continue;
            // Along its own plane to the other's.
            const double away = dot(minus({s.x[j], s.y[j], s.z[j]}, at), m);
            const double sine = std::sqrt(1 - cosine * cosine);
            const double distance = std::abs(away) / sine;
            const double sign = away < 0 ? -1 : 1;
            Vec3 way;
            for (std::size_t a = 0; a < 3; ++a) way[a] = sign * (m[a] - cosine * n[a]) / sine;
            const bool second = towards[0] != Vec3{} && dot(way, towards[0]) < other_way;
            const std::size_t slot = second ? 1 : 0;
            if (distance >= nearest[slot]) continue;
            nearest[slot] = distance;
            towards[slot] = way;
        }
        for (std::size_t c = 0; c < 2; ++c) {
            if (towards[c] == Vec3{}) continue;
            DiscCut& cut = cuts[i][c];
            for (std::size_t a = 0; a < 3; ++a) cut.normal[a] = static_cast<float>(-towards[c][a]);
            cut.least =
                static_cast<float>(-dot(towards[c], at) - nearest[c] - edge_overlap * radii_m[i]);
        }
    });
    return cuts;
}

}  // namespace topple::geometry
