// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "topple/input.h"

namespace topple::exports {

inline Eigen::Vector3d eigen(const Vec3& v) {
    return {v[0], v[1], v[2]};
}

}  // namespace topple::exports
