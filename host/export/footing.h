// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "export/body.h"

namespace topple::exports {

using Point2 = std::array<double, 2>;

// Where a body rests on others: points of the horizontal plane whose hull it stands on.
std::vector<Point2> footing_of(const std::vector<Body>& bodies, const Body& body);

// How far the plumb line of a body's centre of mass lies inside the hull of points; below 0:
// outside; -infinity without points.
double margin_m(const std::vector<Point2>& points, const Body& body);

// The height of the first part of another body straight below a point; -infinity: there is none.
// Nothing too where a part of its own body lies between.
double height_below_m(const std::vector<Body>& bodies, const Body& body, const Vec3& point);

}  // namespace topple::exports
