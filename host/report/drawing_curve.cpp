// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "report/drawing_parts.h"

namespace topple::report {
namespace {

using Style = Drawing::Style;
using Anchor = Drawing::Anchor;

// A round number at or above `value`.
double nice_ceiling(double value) {
    if (!(value > 0)) return 1;
    const double power = std::pow(10, std::floor(std::log10(value)));
    for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.5}) {
        if (step * power >= value * (1 - 1e-9)) return step * power;
    }
    return 10 * power;
}

}  // namespace

// S(W): what can be released after absorbing W (Eq. 6), a staircase from 0 on.
Drawing draw_curve(const Object& object) {
    constexpr double height = 170, left = 46, right = 10, top = 12, bottom = 34;
    Drawing out{"Instability S(W)", width, height};
    double last_W = 0, last_S = 0;
    std::vector<InstabilityStep> steps;
    for (const InstabilityStep& step : object.instability) {
        if (!std::isfinite(step.W_J) || !std::isfinite(step.S_J)) continue;
        steps.push_back(step);
        last_W = std::max(last_W, step.W_J);
        last_S = std::max(last_S, step.S_J);
    }
    const double end_W = nice_ceiling(std::max(1.15 * last_W, 1e-6)), end_S = nice_ceiling(last_S);
    const auto at = [&](double W, double S) {
        return Point{left + (width - left - right) * W / end_W,
                     height - bottom - (height - top - bottom) * S / end_S};
    };
    out.strokes.push_back({Style::axis, {at(0, end_S), at(0, 0), at(end_W, 0)}});
    Drawing::Stroke curve{Style::curve, {at(0, 0)}};
    double S = 0;
    for (const InstabilityStep& step : steps) {
        curve.points.push_back(at(step.W_J, S));
        S = step.S_J;
        curve.points.push_back(at(step.W_J, S));
    }
    curve.points.push_back(at(end_W, S));
    out.strokes.push_back(std::move(curve));
    out.say({left - 5, top + 6}, Anchor::end, joules(end_S));
    out.say({left - 5, height - bottom + 4}, Anchor::end, "0");
    out.say({left, height - bottom + 15}, Anchor::start, "0");
    out.say({width - right, height - bottom + 15}, Anchor::end, joules(end_W));
    out.say({width / 2, height - 6}, Anchor::middle, "energy absorbed W");
    out.say({left + 6, top + 6}, Anchor::start, "can release S(W)");
    return out;
}

}  // namespace topple::report
