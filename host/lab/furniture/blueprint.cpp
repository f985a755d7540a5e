// SPDX-License-Identifier: MIT
#include "lab/furniture/blueprint.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/vectors.h"

namespace topple::scenes {
namespace {

// A part that does not lean and whose lowest point is at `bottom`.
Part upright(Shape shape, const char* name, double x, double y, double bottom, const Vec3& size,
             double yaw = 0) {
    return {shape, {x, y, bottom + size[2] / 2}, size, yaw, 0, -1, name};
}

}  // namespace

int Blueprint::add(Part part) {
    parts.push_back(std::move(part));
    return static_cast<int>(parts.size()) - 1;
}

int Blueprint::box(const char* part, double x, double y, double bottom, const Vec3& size,
                   double yaw) {
    return add(upright(Shape::box, part, x, y, bottom, size, yaw));
}

int Blueprint::cylinder(const char* part, double x, double y, double bottom, double diameter,
                        double height) {
    return add(upright(Shape::cylinder, part, x, y, bottom, {diameter, diameter, height}));
}

int Blueprint::lying(const char* part, double x, double y, double bottom, double length,
                     double diameter, double yaw) {
    return add(
        upright(Shape::lying_cylinder, part, x, y, bottom, {length, diameter, diameter}, yaw));
}

int Blueprint::sphere(const char* part, double x, double y, double bottom, double diameter) {
    return add(upright(Shape::sphere, part, x, y, bottom, {diameter, diameter, diameter}));
}

int Blueprint::cone(const char* part, double x, double y, double bottom, double diameter,
                    double height, double top_ratio) {
    Part p = upright(Shape::cone, part, x, y, bottom, {diameter, diameter, height});
    p.top_ratio = top_ratio;
    return add(std::move(p));
}

int Blueprint::rounded(const char* part, double x, double y, double bottom, const Vec3& size,
                       double rounding) {
    Part p = upright(Shape::rounded_box, part, x, y, bottom, size);
    p.rounding = rounding;
    return add(std::move(p));
}

int Blueprint::cushion(const char* part, const Vec3& middle, const Vec3& size, double lean,
                       double rounding) {
    Part p{Shape::rounded_box, middle, size, 0, 0, -1, part};
    p.lean = lean;
    p.rounding = rounding;
    return add(std::move(p));
}

int Blueprint::revolved(const char* part, double x, double y, double bottom,
                        solids::Profile profile) {
    double radius = 0, low = profile.front()[1], high = low;
    for (const auto& [r, z] : profile) {
        radius = std::max(radius, r);
        low = std::min(low, z);
        high = std::max(high, z);
    }
    for (auto& point : profile) point[1] -= (low + high) / 2;
    const Vec3 center{x, y, bottom + (low + high) / 2};
    Part p{Shape::revolved, center, {2 * radius, 2 * radius, high - low}, 0, 0, -1, part};
    p.profile = std::move(profile);
    return add(std::move(p));
}

int Blueprint::leaning(const char* part, double x, double y, double bottom, const Vec3& size,
                       double lean, double yaw) {
    const double s = std::sin(lean), c = std::cos(lean);
    // From the lowest edge, which is on the side that it leans to, to the middle.
    const double back = (std::copysign(size[1], lean) * c - size[2] * s) / 2;
    const double up = (size[1] * std::abs(s) + size[2] * c) / 2;
    const Vec3 middle{x - std::sin(yaw) * back, y + std::cos(yaw) * back, bottom + up};
    Part p{Shape::box, middle, size, yaw, 0, -1, part};
    p.lean = lean;
    return add(std::move(p));
}

int Blueprint::bar(const char* part, const Vec3& from, const Vec3& to, double diameter) {
    const Vec3 way = minus(to, from);
    const double length = std::hypot(way[0], way[1], way[2]);
    const Vec3 middle{(from[0] + to[0]) / 2, (from[1] + to[1]) / 2, (from[2] + to[2]) / 2};
    Part p{Shape::cylinder, middle, {diameter, diameter, length}, 0, 0, -1, part};
    p.yaw = std::atan2(way[0], -way[1]);
    p.lean = std::acos(way[2] / length);
    return add(std::move(p));
}

int Blueprint::leg(const char* part, double x, double y, double bottom, double top, double diameter,
                   double lean, double heading) {
    // The rims of the slanted ends reach further than the axis does.
    const double rim = diameter / 2 * std::sin(lean);
    const double spread = (top - bottom - 2 * rim) * std::tan(lean);
    return bar(part, {x + spread * std::cos(heading), y + spread * std::sin(heading), bottom + rim},
               {x, y, top - rim}, diameter);
}

void Blueprint::legs(const char* part, double x, double y, double thickness, double height,
                     bool round, int under) {
    for (const auto [sx, sy] : corners) {
        const int leg = foot(round ? cylinder(part, sx * x, sy * y, 0, thickness, height)
                                   : box(part, sx * x, sy * y, 0, {thickness, thickness, height}));
        if (under >= 0) join(under, leg);
    }
}

void Blueprint::rungs(int left, int right, int count, double diameter) {
    const Part a = parts[left], b = parts[right];
    const double length = b.center[0] - a.center[0] - a.size[0];
    for (int k = 1; k <= count; ++k) {
        const double up = a.size[2] * (static_cast<double>(k) / (count + 1) - 0.5);
        const int rung =
            lying("rung", (a.center[0] + b.center[0]) / 2, a.center[1] - up * std::sin(a.lean),
                  a.center[2] + up * std::cos(a.lean) - diameter / 2, length, diameter);
        join(left, rung);
        join(right, rung);
    }
}

void Blueprint::arm(int base, const Vec3& from, const std::vector<Segment>& segments,
                    double thickness, double shade) {
    const double ball = 0.8 * thickness;  // radius
    Vec3 at{from[0], from[1], from[2] + ball}, across{};
    int last = sphere("joint", at[0], at[1], at[2] - ball, 2 * ball);
    join(base, last);
    for (const Segment& segment : segments) {
        const Vec3 way{0, std::sin(segment.lean), std::cos(segment.lean)};
        const Vec3 end = along(at, segment.length, way);
        const int rod = bar("arm", along(at, ball, way), along(end, -ball, way), thickness);
        const int joint = sphere("joint", end[0], end[1], end[2] - ball, 2 * ball);
        join(last, rod);
        join(rod, joint);
        last = joint;
        at = end;
        across = {0, way[2], -way[1]};
    }
    // The shade points across the last bar, its narrow end at the ball.
    const double height = 0.8 * shade;
    const int lamp = bar("shade", along(at, ball + height, across), along(at, ball, across), shade);
    Part& part = parts[lamp];
    part.shape = Shape::cone;
    part.top_ratio = 0.4;
    join(last, lamp);
}

void Blueprint::stand_on(int part, double clearance, const char* where, double rim) {
    const Part& p = parts[part];
    // The square inside a disc.
    const bool square = p.shape == Shape::box || p.shape == Shape::rounded_box;
    const double share = square ? 0.5 : 0.5 * 0.7071;
    surfaces.push_back({part, p.center[0], p.center[1], share * p.size[0] - rim,
                        share * p.size[1] - rim, clearance, where});
}

Bounds Blueprint::bounds() const {
    Bounds all = no_bounds();
    for (const Part& part : parts) extend(all, part.bounds());
    return all;
}

Blueprint lone_box(const char* name, const char* part, const Vec3& size) {
    Blueprint b(name);
    b.foot(b.box(part, 0, 0, 0, size));
    return b;
}

Blueprint lone_rounded(const char* name, const char* part, const Vec3& size, double rounding) {
    Blueprint b(name);
    b.foot(b.rounded(part, 0, 0, 0, size, rounding));
    return b;
}

Blueprint lone_revolved(const char* name, const char* part, solids::Profile profile) {
    Blueprint b(name);
    b.foot(b.revolved(part, 0, 0, 0, std::move(profile)));
    return b;
}

}  // namespace topple::scenes
