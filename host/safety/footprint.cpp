// SPDX-License-Identifier: MIT
#include "safety/footprint.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace topple::safety {
namespace {

// Weight of a part in a cell that lies `ahead` of and `aside` from the walker, in metres, where the
// path takes `spacing` metres from cell to cell.
double part_weight(const BodyPart& part, const HumanOptions& options, double ahead, double aside,
                   double spacing) {
    const double height = options.body_height_m;
    const double low = -part.back * height, high = part.front * height, reach = part.reach * height;
    const double covered = std::min(ahead + spacing / 2, high) - std::max(ahead - spacing / 2, low);
    if (covered <= 0) return 0;
    const double stray = aside - reach;
    if (stray >= options.wander_m && stray > 0) return 0;
    return part.share * covered / (high - low) * (stray > 0 ? 1 - stray / options.wander_m : 1.0);
}

std::int32_t footprint_radius(double cell_m, const HumanOptions& options) {
    double reach = 0;
    for (const BodyPart& part : body_parts) {
        const double side = part.reach * options.body_height_m + options.wander_m;
        const double along = std::max(part.back, part.front) * options.body_height_m + cell_m;
        reach = std::max(reach, std::hypot(side, along));
    }
    return static_cast<std::int32_t>(std::ceil(reach / cell_m));
}

}  // namespace

Footprint make_footprint(double cell_m, const HumanOptions& options) {
    const std::int32_t radius = footprint_radius(cell_m, options);
    const auto weight_at = [&](unsigned part, unsigned d, std::int32_t x, std::int32_t y) {
        const auto [dx, dy] = direction(d);
        const double ahead = -(x * dx + y * dy) * cell_m,
                     aside = std::fabs(x * dy - y * dx) * cell_m;
        const double spacing = cell_m / std::max(std::fabs(dx), std::fabs(dy));
        return part_weight(body_parts[part], options, ahead, aside, spacing);
    };
    Footprint out;
    std::vector<Footprint::Offset> all;
    for (std::int32_t y = -radius; y <= radius; ++y) {
        for (std::int32_t x = -radius; x <= radius; ++x) {
            bool used = false;
            for (unsigned part = 0; part < body_parts.size() && !used; ++part) {
                for (unsigned d = 0; d < direction_count && !used; ++d)
                    used = weight_at(part, d, x, y) > 0;
            }
            if (!used) continue;
            out.offsets.push_back({x, y});
            out.radius = std::max({out.radius, std::abs(x), std::abs(y)});
        }
    }
    out.first.push_back(0);
    for (unsigned part = 0; part < body_parts.size(); ++part) {
        for (unsigned d = 0; d < direction_count; ++d) {
            for (std::size_t row = 0; row < out.offsets.size(); ++row) {
                const double weight = weight_at(part, d, out.offsets[row].x, out.offsets[row].y);
                if (weight <= 0) continue;
                out.row.push_back(static_cast<std::uint32_t>(row));
                out.weight.push_back(static_cast<float>(weight));
            }
            out.first.push_back(static_cast<std::uint32_t>(out.row.size()));
        }
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

Bands bands_of(const BodyPart& part) {
    Bands bands;
    for (unsigned b = 0; b < band_count; ++b) {
        const double middle = (b + 0.5) / band_count;
        if (middle < part.low || middle >= part.high) continue;
        if (bands.count++ == 0) bands.first = b;
    }
    return bands;
}

}  // namespace topple::safety
