// SPDX-License-Identifier: MIT
#include "lab/solids/scene.h"

#include <cmath>
#include <limits>

namespace topple::scenes {

Vec3 World::to_input(const Vec3& p) const {
    return {tilt[0] * p[0] + tilt[1] * p[1] + tilt[2] * p[2],
            tilt[3] * p[0] + tilt[4] * p[1] + tilt[5] * p[2],
            tilt[6] * p[0] + tilt[7] * p[1] + tilt[8] * p[2]};
}

Vec3 World::to_room(const Vec3& p) const {
    return {tilt[0] * p[0] + tilt[3] * p[1] + tilt[6] * p[2],
            tilt[1] * p[0] + tilt[4] * p[1] + tilt[7] * p[2],
            tilt[2] * p[0] + tilt[5] * p[1] + tilt[8] * p[2]};
}

std::pair<double, std::int32_t> World::distance(const Vec3& p) const {
    std::pair<double, std::int32_t> best{std::numeric_limits<double>::infinity(), -1};
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const double d = parts[k].distance(p);
        if (d < best.first) best = {d, static_cast<std::int32_t>(k)};
    }
    return best;
}

std::array<double, 9> rotation(const Vec3& axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle), x = axis[0], y = axis[1], z = axis[2];
    return {c + x * x * (1 - c),     x * y * (1 - c) - z * s, x * z * (1 - c) + y * s,
            y * x * (1 - c) + z * s, c + y * y * (1 - c),     y * z * (1 - c) - x * s,
            z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)};
}

}  // namespace topple::scenes
