// SPDX-License-Identifier: MIT
#include "physics/weld.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace topple::physics {

std::vector<Vec3> welded(const std::vector<Vec3>& points, double tolerance_m) {
    using Cell = std::array<std::int64_t, 3>;
    std::map<Cell, std::vector<Vec3>> kept;
    const auto cell_of = [&](const Vec3& p) {
        Cell out{};
        for (std::size_t a = 0; a < 3; ++a)
            out[a] = static_cast<std::int64_t>(std::floor(p[a] / tolerance_m));
        return out;
    };
    std::vector<Vec3> out;
    for (const Vec3& p : points) {
        const Cell at = cell_of(p);
        bool near = false;
        for (std::int64_t n = 0; n < 27 && !near; ++n) {
            const auto beside =
                kept.find({at[0] + n / 9 - 1, at[1] + n / 3 % 3 - 1, at[2] + n % 3 - 1});
            if (beside == kept.end()) continue;
            for (const Vec3& q : beside->second)
                near = near || std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) <= tolerance_m;
        }
        if (near) continue;
        kept[at].push_back(p);
        out.push_back(p);
    }
    return out;
}

}  // namespace topple::physics
