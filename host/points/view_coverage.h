// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "topple/input.h"

namespace topple {

// Whether frames show their scene from around: the camera moved about it, and looked in directions
// of more than half a circle. Otherwise much of what hides under a table top is mere shadow.
class ViewCoverage {
  public:
    // axes: two level ones, then up, in the frame of the poses.
    explicit ViewCoverage(const std::array<Vec3, 3>& axes) : axes_(axes) {}
    void add(const Mat4& camera_to_world);
    bool from_around() const;

  private:
    double along(std::size_t axis, const Mat4& pose, std::size_t column) const;

    std::array<Vec3, 3> axes_;
    std::vector<double> azimuths_;                            // of the viewing directions, radians
    std::array<double, 2> low_{inf, inf}, high_{-inf, -inf};  // positions, metres
    static constexpr double inf = std::numeric_limits<double>::infinity();
};

}  // namespace topple
