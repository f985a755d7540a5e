// SPDX-License-Identifier: MIT
#include "report/view_walks.h"

#include <algorithm>
#include <cmath>

#include "core/field_rules.h"
#include "core/ranked.h"

namespace topple::report {
namespace {

bool fits(const Walks& walks) {
    if (walks.nx <= 0 || walks.ny <= 0 || walks.nx > (1 << 20) || walks.ny > (1 << 20))
        return false;
    const auto size = static_cast<std::size_t>(walks.nx * walks.ny);
    return walks.floor_m.size() == size && walks.visits.size() == size &&
           rules::finite(walks.corner_m) && rules::finite(walks.along_x_m) &&
           rules::finite(walks.along_y_m);
}

// The mean visits of a merged cell, or -1 where none of its cells is walkable; and their floor.
struct Merged {
    double visits = -1, floor_m = 0;
};

Merged merged(const Walks& walks, std::int64_t x0, std::int64_t y0, std::int64_t merge) {
    double visits = 0, floor = 0;
    int count = 0;
    for (std::int64_t y = y0; y < std::min(y0 + merge, walks.ny); ++y) {
        for (std::int64_t x = x0; x < std::min(x0 + merge, walks.nx); ++x) {
            const auto at = static_cast<std::size_t>(y * walks.nx + x);
            if (!(walks.visits[at] >= 0) || !std::isfinite(walks.visits[at]) ||
                !std::isfinite(walks.floor_m[at]))
                continue;
            visits += double{walks.visits[at]};
            floor += double{walks.floor_m[at]};
            ++count;
        }
    }
    if (count == 0) return {};
    return {visits / count, floor / count};
}

// What all but one in a hundred of the values that are not 0 stay below.
double busy(std::vector<double> values) {
    std::erase_if(values, [](double v) { return !(v > 0); });
    if (values.empty()) return 0;
    return ranked(values, (values.size() - 1) * 99 / 100);
}

}  // namespace

PackedWalks pack_walks(const Walks& walks, const Rotation& view_from_input, std::size_t cells) {
    PackedWalks out;
    if (!fits(walks)) return out;
    std::int64_t merge = 1;
    const auto across = [&](std::int64_t n) { return (n + merge - 1) / merge; };
    while (static_cast<std::size_t>(across(walks.nx) * across(walks.ny)) > cells) ++merge;
    out.nx = across(walks.nx);
    out.ny = across(walks.ny);
    out.corner_m = turned(view_from_input, walks.corner_m);
    out.along_x_m = turned(view_from_input, walks.along_x_m);
    out.along_y_m = turned(view_from_input, walks.along_y_m);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.along_x_m[axis] *= static_cast<double>(merge);
        out.along_y_m[axis] *= static_cast<double>(merge);
    }
    std::vector<double> visits;
    for (std::int64_t y = 0; y < out.ny; ++y) {
        for (std::int64_t x = 0; x < out.nx; ++x) {
            const Merged cell = merged(walks, x * merge, y * merge, merge);
            visits.push_back(cell.visits);
            out.floor_mm.push_back(static_cast<std::int16_t>(
                std::lround(std::clamp(cell.floor_m * 1000, -32000.0, 32000.0))));
        }
    }
    out.most = busy(visits);
    for (const double v : visits) {
        const double share = out.most > 0 ? std::min(std::max(v, 0.0) / out.most, 1.0) : 0.0;
        const auto shade = static_cast<std::uint8_t>(1 + std::lround(254 * std::sqrt(share)));
        out.shade.push_back(v < 0 ? std::uint8_t{0} : shade);
    }
    for (const auto& path : walks.paths) {
        std::vector<std::array<float, 3>> way;
        for (const Vec3& corner : path) {
            const Vec3 p = turned(view_from_input, corner);
            if (rules::finite(p)) way.push_back({float(p[0]), float(p[1]), float(p[2])});
        }
        if (way.size() > 1) out.paths.push_back(std::move(way));
    }
    return out;
}

}  // namespace topple::report
