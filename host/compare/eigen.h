// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "topple/input.h"

namespace topple::comparing {

inline Eigen::Map<const Eigen::Vector3d> mapped(const Vec3& v) {
    return Eigen::Map<const Eigen::Vector3d>(v.data());
}

}  // namespace topple::comparing
