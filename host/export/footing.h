// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "export/body.h"

namespace topple::exports {

using Point2 = std::array<double, 2>;

// Where a body rests on others that stand: points of the horizontal plane whose hull it stands on.
// stands: by body; those of two that lean on one another and on nothing else do not.
std::vector<Point2> footing_of(const std::vector<Body>& bodies, const std::vector<bool>& stands,
                               const Body& body);

// How far the plumb line of a centre of mass lies inside the hull of points; below 0: outside;
// -infinity without points.
double margin_m(const std::vector<Point2>& points, const Vec3& center_m);

// The gap below a body along a plumb line: from its lowest point there down to what is below.
struct Gap {
    double from_m = 0, to_m = 0;  // heights
    std::size_t on = 0;           // which body is below
};
// Nothing where the body does not lie on that line, or where nothing, what does not stand itself,
// or a steep side is below.
std::optional<Gap> gap_below(const std::vector<Body>& bodies, const std::vector<bool>& stands,
                             const Body& body, const Point2& at);

}  // namespace topple::exports
