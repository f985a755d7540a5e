// SPDX-License-Identifier: MIT
#include "safety/human/footprint.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

namespace topple::safety {
namespace {

// Passes rarer than one in a hundred thousand walks past a place are left out.
constexpr float least_weight = 1e-5f;

}  // namespace

// An entry for each layer, direction and offset that has passes.
Footprint make_footprint(double cell_m, const SecondaryMotion& motion) {
    const auto radius = static_cast<std::int32_t>(std::ceil(motion.reach_m / cell_m)) + 1;
    const auto weight_at = [&](const MotionLayer::Way& way, unsigned heading, std::int32_t x,
                               std::int32_t y) {
        const auto [dx, dy] = direction(heading);
        const double ahead = -(x * dx + y * dy) * cell_m, aside = (x * dy - y * dx) * cell_m;
        const double spacing = cell_m / std::max(std::fabs(dx), std::fabs(dy));
        return way.passes(ahead, aside, spacing);
    };
    const auto heading_of = [](const MotionLayer::Way& way, unsigned d) {
        return (d + direction_count - way.turn) % direction_count;
    };
    struct Entry {
        std::int32_t x, y;
        unsigned heading;
        float weight;
    };
    std::vector<Entry> entries;
    std::vector<std::size_t> first{0};
    std::map<std::pair<std::int32_t, std::int32_t>, std::uint32_t> rows;  // by y, then x
    for (const MotionLayer& layer : motion.layers) {
        for (unsigned d = 0; d < direction_count; ++d) {
            for (const MotionLayer::Way& way : layer.ways) {
                const unsigned heading = heading_of(way, d);
                for (std::int32_t y = -radius; y <= radius; ++y) {
                    for (std::int32_t x = -radius; x <= radius; ++x) {
                        const auto weight = static_cast<float>(weight_at(way, heading, x, y));
                        if (weight <= least_weight) continue;
                        entries.push_back({x, y, heading, weight});
                        rows.emplace(std::pair(y, x), 0);
                    }
                }
            }
            first.push_back(entries.size());
        }
    }
    Footprint out;
    for (auto& [place, row] : rows) {
        row = static_cast<std::uint32_t>(out.offsets.size());
        out.offsets.push_back({place.second, place.first});
        out.radius = std::max({out.radius, std::abs(place.second), std::abs(place.first)});
    }
    for (const std::size_t f : first) out.first.push_back(static_cast<std::uint32_t>(f));
    for (const Entry& e : entries) {
        out.row.push_back(rows.at({e.y, e.x}));
        out.heading.push_back(static_cast<std::uint8_t>(e.heading));
        out.weight.push_back(e.weight);
    }
    return out;
}

SightLines sight_lines(const Footprint& footprint, std::int32_t width) {
    SightLines lines;
    lines.first.push_back(0);
    const auto rounded = [](std::int32_t v, std::int32_t n) {  // v / n to the nearest
        return (2 * std::abs(v) + n) / (2 * n) * (v < 0 ? -1 : 1);
    };
    const auto add = [&](std::int32_t xa, std::int32_t ya, std::int32_t xb, std::int32_t yb) {
        lines.a.push_back(ya * width + xa);
        lines.b.push_back(yb * width + xb);
    };
    for (const auto& [x, y] : footprint.offsets) {
        const std::int32_t n = std::max(std::abs(x), std::abs(y));
        std::int32_t px = 0, py = 0;
        for (std::int32_t s = 1; s <= n; ++s) {
            const std::int32_t sx = rounded(x * s, n), sy = rounded(y * s, n);
            if (sx != px && sy != py) add(sx, py, px, sy);  // between the two beside the diagonal
            if (s < n) add(sx, sy, sx, sy);
            px = sx;
            py = sy;
        }
        lines.first.push_back(static_cast<std::uint32_t>(lines.a.size()));
    }
    return lines;
}

}  // namespace topple::safety
