// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "physics/sliding.h"
#include "physics/tipping.h"

namespace topple::physics {

const char* to_string(Instability::Mode mode) {
    constexpr const char* names[] = {"none", "tip", "slide"};
    return names[static_cast<std::size_t>(mode)];
}

Instability combine_curves(const Stability& tip, const SlideResult& slide) {
    std::vector<InstabilityStep> steps = tip.curve;
    const bool slides = slide.found && slide.released_J > 0;
    if (slides) steps.push_back({slide.absorbed_J, slide.released_J});
    std::stable_sort(
        steps.begin(), steps.end(),
        [](const InstabilityStep& a, const InstabilityStep& b) { return a.W_J < b.W_J; });
    Instability result;
    for (const InstabilityStep& step : steps) {
        if (!(step.S_J > (result.curve.empty() ? 0 : result.curve.back().S_J))) continue;
        if (!result.curve.empty() && result.curve.back().W_J == step.W_J) {
            result.curve.back().S_J = step.S_J;
        } else {
            result.curve.push_back(step);
        }
    }
    using Mode = Instability::Mode;
    const auto take = [&](Mode mode, double barrier_J, double release_J, const auto& way) {
        result.mode = mode;
        result.barrier_J = barrier_J;
        result.release_J = release_J;
        result.weakest = way.direction;
        result.edge = way.edge;
        result.drop_m = way.drop_m;
        if (mode != Mode::none) result.direction = way.direction;
    };
    // Tipping may find its first release behind a higher pass than its lowest.
    const InstabilityStep* first = tip.curve.empty() ? nullptr : &tip.curve.front();
    const bool tips = tip.release_J > 0 || (tip.barrier_J > 0 && (slides || first));
    if (tips && !(slides && slide.absorbed_J < tip.barrier_J)) {
        take(Mode::tip, tip.barrier_J, tip.release_J, tip.easiest);
    } else if (slides && !(first && first->W_J < slide.absorbed_J)) {
        take(Mode::slide, slide.absorbed_J, slide.released_J, slide);
        result.onto = slide.onto;
    } else if (first) {
        take(Mode::tip, first->W_J, first->S_J, *tip.releasing);
    } else {
        take(Mode::none, tip.barrier_J, 0, tip.easiest);
    }
    return result;
}

double tipping_barrier_J(const Candidate& body, double margin_m) {
    const double height = std::max(body.body.center[2] - body.support_height_m, 0.0);
    return body.body.mass_kg * gravity * rise_over_edge_m(height, margin_m);
}

double barrier_error_J(const Candidate& body, const BodyError& known, const Stability& tip,
                       const Instability& how, double margin_error_m, const Friction& friction) {
    const double weight = body.body.mass_kg * gravity;
    if (!(weight > 0)) return 0;
    const double of_mass = how.barrier_J * known.mass_kg / body.body.mass_kg;
    if (how.mode == Instability::Mode::slide)
        return std::hypot(friction.coefficient * weight * margin_error_m, of_mass,
                          how.barrier_J * friction.error_share());
    if (!how.edge || !(tip.margin_m > 0)) return std::hypot(weight * margin_error_m, of_mass);
    const auto& [a, b] = *how.edge;
    const double beside =
        std::max(0.0, ((a[0] + b[0]) / 2 - body.body.center[0]) * how.weakest[0] +
                          ((a[1] + b[1]) / 2 - body.body.center[1]) * how.weakest[1]);
    const double height = std::max(body.body.center[2] - body.support_height_m, margin_error_m);
    const double radius = std::hypot(height, beside);
    const double tipping = weight * std::max(std::hypot(beside / radius * margin_error_m,
                                                        (1 - height / radius) * known.center_m[2]),
                                             rise_over_edge_m(height, margin_error_m));
    return std::hypot(tipping, of_mass);
}

}  // namespace topple::physics
