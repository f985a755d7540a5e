// SPDX-License-Identifier: MIT
#include "result/labelled_points.h"

#include <utility>

namespace topple {
namespace {

// The coordinates and colours of the points: moved, where they are the input's own.
void take_coordinates(Observation& input, ScenePoints& out) {
    if (input.own.size() > 0) {
        out.x = std::move(input.own.x);
        out.y = std::move(input.own.y);
        out.z = std::move(input.own.z);
        out.red = std::move(input.own.red);
        out.green = std::move(input.own.green);
        out.blue = std::move(input.own.blue);
        return;
    }
    const auto as_given = [](const FloatColumn& column, std::vector<float>& to) {
        const FloatColumn given = column.less(0);
        to.assign(given.begin(), given.end());
    };
    as_given(input.cloud.x, out.x);
    as_given(input.cloud.y, out.y);
    as_given(input.cloud.z, out.z);
    const auto& [red, green, blue] = input.given_colours;
    out.red.assign(red.begin(), red.end());
    out.green.assign(green.begin(), green.end());
    out.blue.assign(blue.begin(), blue.end());
}

}  // namespace

ScenePoints labelled_points(Observation& input, const Surfaces& geometry, const Volume& voxels,
                            bool coordinates) {
    ScenePoints out;
    out.index = std::move(input.index);
    out.primitive = numbered(geometry.primitive_of_point, voxels.number);
    out.region = geometry.region_of_point;
    const geometry::Surfels& s = geometry.surfels;
    for (auto* axis : {&out.nx, &out.ny, &out.nz}) axis->reserve(out.primitive.size());
    for (const std::uint32_t surfel : s.of_point) {
        out.nx.push_back(s.nx[surfel]);
        out.ny.push_back(s.ny[surfel]);
        out.nz.push_back(s.nz[surfel]);
    }
    if (coordinates) take_coordinates(input, out);
    return out;
}

}  // namespace topple
