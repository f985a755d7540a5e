// SPDX-License-Identifier: MIT
#pragma once

#include "core/vectors.h"
#include "host/physics/solids.h"
#include "lab/random.h"
#include "oracle/geodesic_sphere.h"
#include "physics/qhull.h"

// Convex hulls, for tests of pose landscapes.
namespace topple::test {

struct Hull {
    std::vector<Vec3> points;
    Vec3 center{};  // of mass
    double volume_m3 = 0;
};

// A solid of uniform density, from its points.
inline Hull uniform_hull(std::vector<Vec3> points) {
    Hull hull{std::move(points), {}, 0};
    const auto shape = physics::convex_hull(hull.points);
    const Vec3 origin = hull.points.at(shape.value().vertices[0]);
    Vec3 sum{};
    for (const auto& face : shape->faces) {
        for (std::size_t n = 1; n + 1 < face.size(); ++n) {
            const Vec3 a = minus(hull.points[face[0]], origin),
                       b = minus(hull.points[face[n]], origin),
                       c = minus(hull.points[face[n + 1]], origin);
            const double volume = dot(a, cross(b, c)) / 6;
            hull.volume_m3 += volume;
            for (std::size_t k = 0; k < 3; ++k) sum[k] += volume * (a[k] + b[k] + c[k]) / 4;
        }
    }
    hull.center = along(origin, 1 / hull.volume_m3, sum);
    return hull;
}

// About the origin.
inline Hull box_hull(double a, double b, double c) {
    Hull hull{{}, {}, a * b * c};
    for (const double x : {-a / 2, a / 2}) {
        for (const double y : {-b / 2, b / 2}) {
            for (const double z : {-c / 2, c / 2}) hull.points.push_back({x, y, z});
        }
    }
    return hull;
}

// Regular n-gons of radius r at z = 0 and z = h.
inline std::vector<Vec3> prism_points(double r, double h, unsigned n) {
    std::vector<Vec3> points;
    for (const auto& p : ring(r, n)) {
        points.push_back({p[0], p[1], 0});
        points.push_back({p[0], p[1], h});
    }
    return points;
}

// The half ball of radius r above z = 0, by facets that touch it: `bands` of n each, those at the
// rim upright and one flat at the top.
inline std::vector<Vec3> dome_points(double r, unsigned bands, unsigned n) {
    const double step = std::numbers::pi / 2 / bands, out = 1 / std::cos(std::numbers::pi / n);
    std::vector<Vec3> points;
    for (const auto& p : ring(r * out, n)) points.push_back({p[0], p[1], 0});
    for (unsigned band = 0; band < bands; ++band) {
        const double angle = (band + 0.5) * step, at = r / std::cos(step / 2);
        for (const auto& p : ring(at * std::cos(angle) * out, n))
            points.push_back({p[0], p[1], at * std::sin(angle)});
    }
    return points;
}

// Corners of a geodesic ball.
inline std::vector<Vec3> ball_points(double r, unsigned frequency) {
    const SphereMesh mesh = geodesic_sphere(frequency);
    std::vector<Vec3> points;
    for (std::size_t n = 0; n < mesh.size(); ++n)
        points.push_back({r * mesh.x[n], r * mesh.y[n], r * mesh.z[n]});
    return points;
}

inline Vec3 random_direction(scenes::Random& random) {
    const double z = random(-1, 1), angle = random(0, 2 * std::numbers::pi),
                 r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

// About the origin, by a random rotation.
inline std::vector<Vec3> turned(std::vector<Vec3> points, scenes::Random& random) {
    const Vec3 x = random_direction(random), y = unit(cross(x, random_direction(random))),
               z = cross(x, y);
    for (Vec3& p : points) p = {dot(x, p), dot(y, p), dot(z, p)};
    return points;
}

// Points in a ball of radius 0.1 m, stretched by axes of their own: round for `stretch` 1.
inline Hull random_hull(std::uint64_t seed, unsigned count, double stretch = 1) {
    scenes::Random random(seed);
    const std::array<double, 3> size{0.1 * stretch, 0.1 * random(1 / stretch, stretch), 0.1};
    std::vector<Vec3> points;
    while (points.size() < count) {
        Vec3 p{};
        for (double& x : p) x = random(-1, 1);
        if (dot(p, p) > 1) continue;
        for (std::size_t a = 0; a < 3; ++a) p[a] *= size[a];
        points.push_back(p);
    }
    return uniform_hull(std::move(points));
}

// A box of random sides of 0.05 to 0.4 m, of which planes cut most corners.
inline Hull cut_box_hull(std::uint64_t seed) {
    scenes::Random random(seed);
    std::array<double, 3> half{};
    for (double& h : half) h = random(0.025, 0.2);
    std::vector<Vec3> points;
    for (unsigned corner = 0; corner < 8; ++corner) {
        Vec3 p{};
        for (std::size_t a = 0; a < 3; ++a) p[a] = corner >> a & 1U ? half[a] : -half[a];
        if (random.chance(0.3)) {
            points.push_back(p);
            continue;
        }
        for (std::size_t a = 0; a < 3; ++a) {
            Vec3 cut = p;
            cut[a] *= 1 - 2 * random(0.05, 0.45);
            points.push_back(cut);
        }
    }
    return uniform_hull(std::move(points));
}

// Heights of all minima and passes by their definitions, of points in general position, ascending.
struct Criticals {
    std::vector<double> minima, passes;
};
inline Criticals critical_poses(const Hull& hull) {
    std::vector<Vec3> v;
    for (const Vec3& p : hull.points) v.push_back(minus(p, hull.center));
    // Whether all points lie on this side of the plane through `foot`, across it.
    const auto carries = [&](const Vec3& foot) {
        const double height2 = dot(foot, foot);
        return std::all_of(v.begin(), v.end(),
                           [&](const Vec3& p) { return dot(p, foot) <= height2 * (1 + 1e-9); });
    };
    Criticals found;
    for (std::size_t a = 0; a < v.size(); ++a) {
        for (std::size_t b = a + 1; b < v.size(); ++b) {
            const Vec3 ab = minus(v[b], v[a]);
            const double t = -dot(v[a], ab) / dot(ab, ab);
            const Vec3 foot = along(v[a], t, ab);
            if (t > 0 && t < 1 && carries(foot)) found.passes.push_back(std::sqrt(dot(foot, foot)));
            for (std::size_t c = b + 1; c < v.size(); ++c) {
                const Vec3 normal = unit(cross(ab, minus(v[c], v[a])));
                const double height = dot(normal, v[a]);
                const Vec3 under{height * normal[0], height * normal[1], height * normal[2]};
                // Barycentric signs of the foot.
                const auto side = [&](const Vec3& p, const Vec3& q) {
                    return dot(normal, cross(minus(q, p), minus(under, p))) > 0;
                };
                if (side(v[a], v[b]) && side(v[b], v[c]) && side(v[c], v[a]) && carries(under))
                    found.minima.push_back(std::abs(height));
            }
        }
    }
    std::sort(found.minima.begin(), found.minima.end());
    std::sort(found.passes.begin(), found.passes.end());
    return found;
}

// Which of the directions `rests` a body comes close to (to 0.03) that starts with `up` up and
// turns down by small steps of the subgradient; their count if none.
inline std::size_t roll_down(const Hull& hull, const Vec3& up, const std::vector<Vec3>& rests) {
    std::vector<Vec3> v;
    double radius2 = 0;
    for (const Vec3& p : hull.points) {
        v.push_back(minus(p, hull.center));
        radius2 = std::max(radius2, dot(v.back(), v.back()));
    }
    const double step = 0.005 / std::sqrt(radius2);
    Vec3 down{-up[0], -up[1], -up[2]};
    for (int round = 0; round < 2000; ++round) {
        for (std::size_t n = 0; n < rests.size(); ++n) {
            if (dot(down, rests[n]) < -0.9995) return n;
        }
        for (int n = 0; n < 10; ++n) {
            double height = -1;
            const Vec3* lowest = nullptr;
            for (const Vec3& p : v) {
                const double h = dot(p, down);
                if (h > height) {
                    height = h;
                    lowest = &p;
                }
            }
            down = unit(along(down, -step, along(*lowest, -height, down)));
        }
    }
    return rests.size();
}

}  // namespace topple::test
