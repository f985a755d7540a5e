// SPDX-License-Identifier: MIT
#include "report/field_arrows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/extents.h"
#include "core/field_rules.h"
#include "report/cells.h"

namespace topple::report {
namespace {

using Arrow = std::array<float, 7>;

// Larger of what is drawn rather.
std::pair<float, float> strength(const Arrow& a) {
    return {a[6], a[3] * a[3] + a[4] * a[4] + a[5] * a[5]};
}

}  // namespace

Arrows pack_arrows(const FieldSamples& field, const Rotation& view_from_input, double edge_m,
                   std::size_t most) {
    Arrows out;
    out.total = field.x.size();
    Extents<double> box;
    std::vector<Arrow> all;
    for (std::size_t i = 0; i < field.x.size(); ++i) {
        const Vec3 p = turned(view_from_input, {field.x[i], field.y[i], field.z[i]});
        const Vec3 v = turned(view_from_input, {field.vx[i], field.vy[i], field.vz[i]});
        if (!rules::finite(p) || !rules::finite(v)) continue;
        box.add(p);
        const float density = std::isfinite(field.density[i]) ? field.density[i] : 0.0f;
        all.push_back({float(p[0]), float(p[1]), float(p[2]), float(v[0]), float(v[1]), float(v[2]),
                       density});
    }
    out.arrow = all;
    for (double edge = edge_m; out.arrow.size() > most; edge *= 1.25) {
        CellTable table;
        out.arrow.clear();
        for (const Arrow& a : all) {
            std::array<std::int32_t, 3> index{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                index[axis] = static_cast<std::int32_t>(
                    std::min((double(a[axis]) - box.low[axis]) / edge, 1e6));
            }
            const auto at = table.insert(index, static_cast<std::uint32_t>(out.arrow.size()));
            if (at == out.arrow.size()) {
                out.arrow.push_back(a);
            } else if (strength(a) > strength(out.arrow[at])) {
                out.arrow[at] = a;
            }
        }
    }
    return out;
}

}  // namespace topple::report
