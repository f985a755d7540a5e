// SPDX-License-Identifier: MIT
#include "export/convex_part.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/vectors.h"
#include "physics/infinity.h"
#include "physics/qhull.h"

namespace topple::exports {
namespace {

// Newell's normal, not of unit length: of a polygon that is flat only to within rounding.
Vec3 newell(const std::vector<Vec3>& corner, const std::vector<std::uint32_t>& outline) {
    Vec3 sum{};
    for (std::size_t n = 0; n < outline.size(); ++n)
        sum = along(sum, 1, cross(corner[outline[n]], corner[outline[(n + 1) % outline.size()]]));
    return sum;
}

// Adds up cones from the first corner to each face.
double volume_of(const ConvexPart& part) {
    double six = 0;
    for (const auto& outline : part.outline) {
        const Vec3 a = minus(part.corner[outline[0]], part.corner[0]);
        for (std::size_t n = 1; n + 1 < outline.size(); ++n) {
            const Vec3 b = minus(part.corner[outline[n]], part.corner[0]);
            const Vec3 c = minus(part.corner[outline[n + 1]], part.corner[0]);
            six += dot(a, cross(b, c));
        }
    }
    return six / 6;
}

// A corner that is so far beyond a plane lies on it.
constexpr double rounding_m = 1e-8;
// What is less is no solid: a cube with an edge of half a millimetre.
constexpr double least_volume_m3 = 1e-10;

// What a plane leaves of a part: its faces, shortened, and one in the plane. Faces keep their
// planes, which many cuts in a row don't blur.
class Clipping {
  public:
    // beyond: by corner, how far it is.
    Clipping(const ConvexPart& part, const std::vector<double>& beyond, ConvexPart& out)
        : part_(part), beyond_(beyond), out_(out), number_(part.corner.size(), none) {}

    void face(std::size_t n) {
        const auto& outline = part_.outline[n];
        std::vector<std::uint32_t> left;
        for (std::size_t k = 0; k < outline.size(); ++k) {
            const std::uint32_t a = outline[k], b = outline[(k + 1) % outline.size()];
            if (inside(a)) left.push_back(kept(a));
            if (inside(a) != inside(b)) left.push_back(crossing(a, b));
        }
        left.erase(std::unique(left.begin(), left.end()), left.end());
        if (left.size() > 1 && left.front() == left.back()) left.pop_back();
        if (left.size() < 3) return;
        out_.outline.push_back(std::move(left));
        out_.face.push_back(part_.face[n]);
    }

    // The points in the plane bound a convex polygon: around its middle they follow one another.
    void cap(const HalfSpace& to) {
        if (on_.size() < 3) return;
        Vec3 middle{};
        for (const std::uint32_t n : on_)
            middle = along(middle, 1 / static_cast<double>(on_.size()), out_.corner[n]);
        const Vec3 some = std::abs(to.normal[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        const Vec3 u = unit(cross(some, to.normal)), v = cross(to.normal, u);
        std::vector<std::pair<double, std::uint32_t>> by_angle;
        for (const std::uint32_t n : on_) {
            const Vec3 from = minus(out_.corner[n], middle);
            by_angle.emplace_back(std::atan2(dot(v, from), dot(u, from)), n);
        }
        std::ranges::sort(by_angle);
        auto& outline = out_.outline.emplace_back();
        for (const auto& [angle, n] : by_angle) outline.push_back(n);
        out_.face.push_back(to);
    }

  private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    bool inside(std::uint32_t n) const { return beyond_[n] <= rounding_m; }
    std::uint32_t add(const Vec3& corner, bool on) {
        const auto n = static_cast<std::uint32_t>(out_.corner.size());
        out_.corner.push_back(corner);
        if (on) on_.push_back(n);
        return n;
    }
    std::uint32_t kept(std::uint32_t n) {
        if (number_[n] == none) number_[n] = add(part_.corner[n], beyond_[n] >= -rounding_m);
        return number_[n];
    }
    // Of an edge that the plane crosses, which two faces share.
    std::uint32_t crossing(std::uint32_t a, std::uint32_t b) {
        if (a > b) std::swap(a, b);
        const std::uint32_t in = inside(a) ? a : b;
        if (beyond_[in] >= -rounding_m) return kept(in);
        for (const auto& [edge, n] : crossed_)
            if (edge == std::pair(a, b)) return n;
        const double t = beyond_[a] / (beyond_[a] - beyond_[b]);
        const std::uint32_t n =
            add(along(part_.corner[a], t, minus(part_.corner[b], part_.corner[a])), true);
        crossed_.emplace_back(std::pair(a, b), n);
        return n;
    }

    const ConvexPart& part_;
    const std::vector<double>& beyond_;
    ConvexPart& out_;
    std::vector<std::uint32_t> number_, on_;
    std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>> crossed_;
};

}  // namespace

std::optional<ConvexPart> hull_part(std::span<const Vec3> points) {
    const auto hull = physics::convex_hull(points);
    if (!hull) return std::nullopt;
    ConvexPart out;
    std::vector<std::uint32_t> number(points.size(), 0);
    for (const std::uint32_t v : hull->vertices) {
        number[v] = static_cast<std::uint32_t>(out.corner.size());
        out.corner.push_back(points[v]);
    }
    for (const auto& face : hull->faces) {
        auto& outline = out.outline.emplace_back();
        for (const std::uint32_t v : face) outline.push_back(number[v]);
        const Vec3 normal = newell(out.corner, outline);
        if (!(dot(normal, normal) > 0)) {
            out.outline.pop_back();
            continue;
        }
        HalfSpace side{unit(normal), -physics::infinity};
        for (const std::uint32_t v : outline)
            side.offset_m = std::max(side.offset_m, dot(side.normal, out.corner[v]));
        out.face.push_back(side);
    }
    out.volume_m3 = volume_of(out);
    if (!(out.volume_m3 > 0)) return std::nullopt;
    for (const Vec3& c : out.corner) out.add(c);
    return out;
}

std::vector<double> face_areas(const ConvexPart& part) {
    std::vector<double> out;
    for (const auto& outline : part.outline) {
        const Vec3 n = newell(part.corner, outline);
        out.push_back(std::sqrt(dot(n, n)) / 2);
    }
    return out;
}

std::optional<ConvexPart> reshaped(const ConvexPart& part, std::span<const Vec3> points) {
    auto out = hull_part(points);
    if (!out) return out;
    out->solid = part.solid;
    out->solid_each_m3 = part.solid_each_m3;
    return out;
}

std::optional<ConvexPart> cut(const ConvexPart& part, const HalfSpace& to) {
    std::vector<double> beyond;
    for (const Vec3& c : part.corner) beyond.push_back(dot(to.normal, c) - to.offset_m);
    if (std::ranges::all_of(beyond, [](double d) { return d <= rounding_m; })) return part;
    ConvexPart out;
    Clipping clipping(part, beyond, out);
    for (std::size_t n = 0; n < part.outline.size(); ++n) clipping.face(n);
    clipping.cap(to);
    if (out.corner.size() < 4) return std::nullopt;
    out.volume_m3 = volume_of(out);
    if (!(out.volume_m3 > least_volume_m3)) return std::nullopt;
    for (const Vec3& c : out.corner) out.add(c);
    out.solid_each_m3 = part.solid_each_m3;
    for (const Vec3& p : part.solid)
        if (dot(to.normal, p) <= to.offset_m + on_plane_m) out.solid.push_back(p);
    return out;
}

ConvexPart shrunk(const ConvexPart& part, double by_m) {
    std::optional<ConvexPart> out = part;
    for (const HalfSpace& side : part.face) {
        out = cut(*out, {side.normal, side.offset_m - by_m});
        if (!out) return part;
    }
    return *std::move(out);
}

ConvexPart moved(ConvexPart part, const Vec3& by) {
    for (Vec3& c : part.corner) c = along(c, 1, by);
    for (Vec3& c : part.solid) c = along(c, 1, by);
    for (HalfSpace& side : part.face) side.offset_m += dot(side.normal, by);
    part.low = along(part.low, 1, by);
    part.high = along(part.high, 1, by);
    return part;
}

Interval extent_along(const ConvexPart& part, const Vec3& n) {
    Interval out{physics::infinity, -physics::infinity};
    for (const Vec3& c : part.corner) {
        const double d = dot(n, c);
        out.low = std::min(out.low, d);
        out.high = std::max(out.high, d);
    }
    return out;
}

std::array<Vec3, 8> Box::corners() const {
    std::array<Vec3, 8> out;
    for (std::size_t n = 0; n < 8; ++n) {
        out[n] = center;
        for (std::size_t a = 0; a < 3; ++a)
            out[n] = along(out[n], (n >> a & 1) != 0 ? half_m[a] : -half_m[a], axis[a]);
    }
    return out;
}

std::optional<Box> as_box(const ConvexPart& part, double tolerance_m) {
    // The two largest faces that are about square to one another give the axes.
    const std::vector<double> area = face_areas(part);
    if (area.size() < 6) return std::nullopt;
    const auto first = static_cast<std::size_t>(std::ranges::max_element(area) - area.begin());
    const Vec3 u = part.face[first].normal;
    constexpr double square = 0.1;  // cosine
    double largest = 0;
    Vec3 v{};
    for (std::size_t n = 0; n < area.size(); ++n) {
        if (std::abs(dot(u, part.face[n].normal)) > square || area[n] <= largest) continue;
        largest = area[n];
        v = part.face[n].normal;
    }
    if (largest == 0) return std::nullopt;
    Box box;
    v = unit(along(v, -dot(u, v), u));
    box.axis = {u, v, cross(u, v)};
    for (std::size_t a = 0; a < 3; ++a) {
        const Interval e = extent_along(part, box.axis[a]);
        box.half_m[a] = (e.high - e.low) / 2;
        box.center = along(box.center, (e.high + e.low) / 2, box.axis[a]);
    }
    // All of its corners lie within the part's half-spaces, or nearly so.
    for (const Vec3& c : box.corners())
        for (const HalfSpace& side : part.face)
            if (dot(side.normal, c) - side.offset_m > tolerance_m) return std::nullopt;
    return box;
}

}  // namespace topple::exports
