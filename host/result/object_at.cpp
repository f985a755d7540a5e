// SPDX-License-Identifier: MIT
#include "topple/object_at.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "io/text.h"

namespace topple {

std::int32_t object_at(const ParseResult& result, const Vec3& place_m, double within_m) {
    const ScenePoints& points = result.scene.points;
    if (!std::ranges::all_of(place_m, [](double x) { return std::isfinite(x); }))
        throw Error(ErrorKind::usage, "object_at: place_m " + io::vector_text(place_m) +
                                          ": expected metres in the frame of the result's "
                                          "points, all finite");
    if (!(within_m >= 0))  // NaN, too
        throw Error(ErrorKind::usage, "object_at: within_m " + io::short_number(within_m) +
                                          ": expected metres from 0 on");
    if (points.x.size() != points.object.size())
        throw Error(ErrorKind::usage,
                    "object_at: the result has no coordinates of its points; add_coordinates() "
                    "puts them there");
    std::int32_t nearest = -1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.object.size(); ++i) {
        if (points.object[i] < 0) continue;
        const double x = points.x[i] - place_m[0], y = points.y[i] - place_m[1],
                     z = points.z[i] - place_m[2];
        const double square = x * x + y * y + z * z;
        if (!(square < least)) continue;
        least = square;
        nearest = points.object[i];
    }
    return least <= within_m * within_m ? nearest : -1;
}

}  // namespace topple
