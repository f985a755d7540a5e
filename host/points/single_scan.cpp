// SPDX-License-Identifier: MIT
#include "points/single_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/vectors.h"

namespace topple::geometry {
namespace {

constexpr std::size_t least_points = 200;
// A point is hidden where all that surrounds it lies nearer by this share of its range: more than
// sensors' noise, less than the distance between one thing and the next.
constexpr double nearer = 0.9;
// Flying points and thin things at their edges; clouds of several views have ten times as many.
constexpr double most_hidden = 0.003;
constexpr double least_facing_share = 0.9;
// A surface goes through the eye where this many points lie within as many spacings of it: that is
// the corner or the middle of a floor that someone chose for the origin, and seen edge-on it hides
// nothing. One stray alone may lie there.
constexpr std::size_t most_at_eye = 3;
constexpr double at_eye_spacings = 5;
// A surface that is seen edge-on, as a floor from a place on it, puts all of its points in few
// directions: this many to a cell of four on average, of this share of all points. Sensors spread
// theirs over what they look at; those that turn about an axis crowd some at its ends.
constexpr std::uint32_t crowd = 32;
constexpr double most_crowded = 0.3;
// A sensor with a limited view sees all but stray points within this angle of its axis.
constexpr double view_cos = 0.5, view_share = 0.98;
// The axis along which it looks is a frame's own axis, give or take this angle.
constexpr double axis_cos = 0.8;

// Directions from the eye on the faces of a cube: face 2 a + s has the largest component along axis
// a, negative for s = 1; u and v, in -1..1, are the other two components over the largest.
struct Directions {
    std::vector<std::uint8_t> face;
    std::vector<float> u, v, range;  // range: distance along the face's axis, metres
    std::size_t size() const { return face.size(); }
};

Directions directions_of(const CloudView& cloud, const Vec3& eye) {
    Directions out;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Vec3 d{cloud.x[i] - eye[0], cloud.y[i] - eye[1], cloud.z[i] - eye[2]};
        std::size_t axis = 0;
        for (std::size_t a = 1; a < 3; ++a) {
            if (std::abs(d[a]) > std::abs(d[axis])) axis = a;
        }
        const double range = std::abs(d[axis]);
        if (!(range > 0)) continue;
        out.face.push_back(static_cast<std::uint8_t>(2 * axis + (d[axis] < 0)));
        out.u.push_back(static_cast<float>(d[(axis + 1) % 3] / range));
        out.v.push_back(static_cast<float>(d[(axis + 2) % 3] / range));
        out.range.push_back(static_cast<float>(range));
    }
    return out;
}

// The nearest range in each cell of an n x n grid on each face; infinite where there is none.
class RangeGrid {
  public:
    RangeGrid(const Directions& d, std::int64_t n)
        : n_(n), nearest_(static_cast<std::size_t>(6 * n * n), infinite), count_(nearest_.size()) {
        for (std::size_t i = 0; i < d.size(); ++i) {
            const std::size_t at = index(d.face[i], cell(d.u[i]), cell(d.v[i]));
            nearest_[at] = std::min(nearest_[at], d.range[i]);
            ++count_[at];
        }
    }
    // How many points lie in cells that hold more than so many.
    std::uint64_t crowded(std::uint32_t many) const {
        std::uint64_t out = 0;
        for (const std::uint32_t count : count_) out += count > many ? count : 0;
        return out;
    }
    // All nine cells around the direction hold something that is clearly nearer.
    bool hides(const Directions& d, std::size_t i) const {
        const std::int64_t x = cell(d.u[i]), y = cell(d.v[i]);
        if (x < 1 || y < 1 || x + 1 >= n_ || y + 1 >= n_) return false;
        for (std::int64_t a = x - 1; a <= x + 1; ++a) {
            for (std::int64_t b = y - 1; b <= y + 1; ++b) {
                if (!(nearest_[index(d.face[i], a, b)] < nearer * double{d.range[i]})) return false;
            }
        }
        return true;
    }
    // Calls visit(direction, not unit) for each cell that something is seen in.
    template <class Visit>
    void for_each_seen(const Visit& visit) const {
        for (std::size_t k = 0; k < nearest_.size(); ++k) {
            if (nearest_[k] == infinite) continue;
            const auto at = static_cast<std::int64_t>(k);
            const std::int64_t face = at / (n_ * n_);
            const auto axis = static_cast<std::size_t>(face / 2);
            const auto middle = [&](std::int64_t c) {
                return (2 * static_cast<double>(c) + 1) / static_cast<double>(n_) - 1;
            };
            Vec3 d{};
            d[axis] = face % 2 == 0 ? 1 : -1;
            d[(axis + 1) % 3] = middle(at / n_ % n_);
            d[(axis + 2) % 3] = middle(at % n_);
            visit(d);
        }
    }
    double seen_area() const {  // of the cube's faces, 4 each
        const auto none = std::count(nearest_.begin(), nearest_.end(), infinite);
        return 4 * (6 - static_cast<double>(none) / static_cast<double>(n_ * n_));
    }

  private:
    static constexpr float infinite = std::numeric_limits<float>::infinity();
    std::int64_t cell(float t) const {
        return std::clamp<std::int64_t>(
            static_cast<std::int64_t>((double{t} + 1) / 2 * static_cast<double>(n_)), 0, n_ - 1);
    }
    std::size_t index(std::uint8_t face, std::int64_t x, std::int64_t y) const {
        return static_cast<std::size_t>((face * n_ + x) * n_ + y);
    }
    std::int64_t n_;
    std::vector<float> nearest_;
    std::vector<std::uint32_t> count_;  // of points
};

bool normals_face(const CloudView& cloud, const Vec3& eye) {
    std::size_t facing = 0;
    for (std::size_t i = 0; i < cloud.nx.size(); ++i) {
        facing += cloud.nx[i] * (eye[0] - cloud.x[i]) + cloud.ny[i] * (eye[1] - cloud.y[i]) +
                      cloud.nz[i] * (eye[2] - cloud.z[i]) >=
                  0;
    }
    return static_cast<double>(facing) >= least_facing_share * static_cast<double>(cloud.nx.size());
}

bool surface_at(const CloudView& cloud, const Vec3& eye, double spacing_m) {
    const double reach = at_eye_spacings * spacing_m;
    std::size_t near = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        near += std::hypot(cloud.x[i] - eye[0], cloud.y[i] - eye[1], cloud.z[i] - eye[2]) <= reach;
    }
    return near > most_at_eye;
}

std::optional<Vec3> customary_up(const RangeGrid& grid) {
    Vec3 sum{};
    double total = 0;
    grid.for_each_seen([&](const Vec3& d) {
        // A cell's solid angle falls with the cube of its distance on the cube.
        const double far = length(d), w = 1 / (far * far * far);
        for (std::size_t a = 0; a < 3; ++a) sum[a] += w * d[a] / far;
        total += w;
    });
    const double all = length(sum);
    if (!(all > 0)) return {};
    double within = 0;
    grid.for_each_seen([&](const Vec3& d) {
        const double far = length(d), along = dot(d, sum) / (far * all);
        if (along >= view_cos) within += 1 / (far * far * far);
    });
    if (within < view_share * total) return {};
    if (sum[2] > axis_cos * all) return Vec3{0, -1, 0};
    if (sum[2] < -axis_cos * all) return Vec3{0, 1, 0};
    if (sum[0] > axis_cos * all) return Vec3{0, 0, 1};
    return {};
}

}  // namespace

std::optional<SingleScan> find_single_scan(const CloudView& cloud, const Vec3& eye,
                                           double spacing_m) {
    if (cloud.size() < least_points || !normals_face(cloud, eye) ||
        surface_at(cloud, eye, spacing_m))
        return {};
    const Directions directions = directions_of(cloud, eye);
    const auto count = static_cast<double>(directions.size());
    // Coarse cells first, of sixteen points each even if the view goes all around: the area that
    // they cover gives the points' spacing.
    const auto coarse =
        std::clamp<std::int64_t>(static_cast<std::int64_t>(std::sqrt(count / (6 * 16))), 4, 64);
    const RangeGrid overview(directions, coarse);
    SingleScan scan;
    scan.eye = eye;
    scan.spacing = std::sqrt(overview.seen_area() / count);
    // Four points to a cell, so that a surface covers all cells of its outline.
    const auto fine =
        std::clamp<std::int64_t>(static_cast<std::int64_t>(1 / scan.spacing), 4, 1024);
    const RangeGrid grid(directions, fine);
    if (static_cast<double>(grid.crowded(crowd)) > most_crowded * count) return {};
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) hidden += grid.hides(directions, i);
    if (static_cast<double>(hidden) > most_hidden * count) return {};
    scan.up = customary_up(overview);
    return scan;
}

}  // namespace topple::geometry
