// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "topple/input.h"

// Solids about their own middle, z their axis: signed distance (exact, negative inside), distance
// along a ray o + t * d (d unit) to the first surface with t > 0 or infinity, and closed-form
// volume. Internal to Part.
namespace topple::scenes::solids {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

// A closed outline in the half plane r >= 0 as points (r, z), from the axis below, around the
// outside, back to the axis: what turns about the axis. It may be concave.
using Profile = std::vector<std::array<double, 2>>;

double box_distance(const Vec3& q, const Vec3& size);
double box_hit(const Vec3& o, const Vec3& d, const Vec3& size);

// All edges and corners rounded by `rounding`, at most half of the least side.
double rounded_box_distance(const Vec3& q, const Vec3& size, double rounding);
double rounded_box_hit(const Vec3& o, const Vec3& d, const Vec3& size, double rounding);
double rounded_box_volume(const Vec3& size, double rounding);

double sphere_hit(const Vec3& o, const Vec3& d, double radius);

// Radius `low` at the bottom, `high` at the top.
struct Frustum {
    double low, high, half_height;
};
double frustum_distance(const Vec3& q, const Frustum& f);
double frustum_hit(const Vec3& o, const Vec3& d, const Frustum& f);
// The first hit with the slanted side alone that is nearer than `best`, or `best`.
double frustum_side_hit(const Vec3& o, const Vec3& d, const Frustum& f, double best);

double revolved_distance(const Vec3& q, const Profile& profile);
double revolved_hit(const Vec3& o, const Vec3& d, const Profile& profile);
double revolved_volume(const Profile& profile);
double revolved_center_z(const Profile& profile);  // of mass
// The outline of the convex hull.
Profile convex_profile(const Profile& profile);

}  // namespace topple::scenes::solids
