// SPDX-License-Identifier: MIT
#include "physics/hidden_walls.h"

#include <cmath>

namespace topple::physics {
namespace {

double dot2(const std::array<double, 2>& axis, const Vec3& p) {
    return axis[0] * p[0] + axis[1] * p[1];
}

bool stands_between(const HiddenWall& wall, const Vec3& from, const Vec3& to) {
    const double before = dot2(wall.normal, from) - wall.offset_m,
                 after = dot2(wall.normal, to) - wall.offset_m;
    if (!(before * after < 0) || to[2] < wall.bottom_m) return false;
    const double share = before / (before - after);
    const double at = dot2(wall.along, from) * (1 - share) + dot2(wall.along, to) * share;
    const double column = std::floor((at - wall.from_m) / wall.column_m);
    if (!(column >= 0 && column < static_cast<double>(wall.top_m.size()))) return false;
    return to[2] <= double{wall.top_m[column]};
}

}  // namespace

std::optional<std::int32_t> HiddenWalls::between(const Vec3& from, const Vec3& to) const {
    for (const HiddenWall& wall : walls_)
        if (stands_between(wall, from, to)) return wall.primitive;
    return std::nullopt;
}

}  // namespace topple::physics
