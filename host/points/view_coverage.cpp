// SPDX-License-Identifier: MIT
#include "points/view_coverage.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace topple {
namespace {

constexpr double least_way_m = 1;  // about the size of furniture

}  // namespace

double ViewCoverage::along(std::size_t axis, const Mat4& pose, std::size_t column) const {
    const Vec3& a = axes_[axis];
    return a[0] * pose[column] + a[1] * pose[4 + column] + a[2] * pose[8 + column];
}

void ViewCoverage::add(const Mat4& camera_to_world) {
    constexpr std::size_t forward = 2, position = 3;  // columns of the pose
    azimuths_.push_back(
        std::atan2(along(1, camera_to_world, forward), along(0, camera_to_world, forward)));
    for (std::size_t axis = 0; axis < 2; ++axis) {
        low_[axis] = std::min(low_[axis], along(axis, camera_to_world, position));
        high_[axis] = std::max(high_[axis], along(axis, camera_to_world, position));
    }
}

bool ViewCoverage::from_around() const {
    if (azimuths_.empty()) return false;
    if (std::hypot(high_[0] - low_[0], high_[1] - low_[1]) < least_way_m) return false;
    std::vector<double> sorted = azimuths_;
    std::sort(sorted.begin(), sorted.end());
    double gap = sorted.front() + 2 * std::numbers::pi - sorted.back();
    for (std::size_t n = 1; n < sorted.size(); ++n) gap = std::max(gap, sorted[n] - sorted[n - 1]);
    return gap < std::numbers::pi;
}

}  // namespace topple
