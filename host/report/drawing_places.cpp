// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/number_text.h"
#include "report/drawing_parts.h"

namespace topple::report {
namespace {

using Style = Drawing::Style;
using Anchor = Drawing::Anchor;

// Codes of the palette: not known, in the way, then work, then falls.
constexpr std::uint8_t unknown = 0, blocked = 1, work = 2, steps = 16, falls = work + steps;

std::vector<Rgb8> palette() {
    std::vector<Rgb8> out{{234, 236, 239}, {92, 96, 104}};
    for (int n = 0; n < steps; ++n) out.push_back(ramp_colour(0.5 + 0.5 * (n + 0.5) / steps));
    for (int n = 0; n < steps; ++n) out.push_back(ramp_colour(0.34 * (1 - (n + 0.5) / steps)));
    return out;
}

std::uint8_t step(double share) {
    return static_cast<std::uint8_t>(std::clamp(share * steps, 0.0, steps - 1.0));
}

}  // namespace

Drawing draw_places(const Landscape::Places& places) {
    constexpr double size = 190, left = 8, top = 6;
    double most = 0, deepest = 0;
    bool unreached = false, in_the_way = false;
    for (const float value : places.energy_J) {
        unreached |= std::isnan(value);
        in_the_way |= std::isinf(value);
        if (!std::isfinite(value)) continue;
        most = std::max(most, double{value});
        deepest = std::max(deepest, -double{value});
    }
    Drawing out{"Places: work to slide it there", width, top + size + 24};
    Drawing::Raster raster{{left, top}, size, places.side, {}, palette()};
    for (std::int32_t row = places.side - 1; row >= 0; --row) {
        for (std::int32_t column = 0; column < places.side; ++column) {
            const double value = places.energy_J[row * places.side + column];
            std::uint8_t code = unknown;
            if (std::isinf(value)) code = blocked;
            if (value < 0) code = static_cast<std::uint8_t>(falls + step(-value / deepest));
            if (value >= 0 && std::isfinite(value))
                code = static_cast<std::uint8_t>(work + step(most > 0 ? value / most : 0));
            raster.code.push_back(code);
        }
    }
    const double right = left + size, bottom = top + size;
    out.strokes.push_back(
        {Style::axis, {{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}}});
    out.dots.push_back({Style::now, {left + size / 2, top + size / 2}, 4});
    out.say({left, bottom + 16}, Anchor::start,
            to_digits(places.side * places.step_m, 2) + " m across, north at the top");
    double y = top + 4;
    const auto key = [&](std::uint8_t code, const std::string& text) {
        out.swatches.push_back({{right + 12, y}, 14, 12, raster.palette[code]});
        out.say({right + 32, y + 10}, Anchor::start, text);
        y += 20;
    };
    key(work, "0 J, as it is");
    if (most > 0) key(falls - 1, joules(most) + " of work");
    if (deepest > 0) key(falls + steps - 1, "falls: " + joules(deepest));
    if (in_the_way) key(blocked, "in the way");
    if (unreached) key(unknown, "out of reach");
    out.raster = std::move(raster);
    return out;
}

}  // namespace topple::report
