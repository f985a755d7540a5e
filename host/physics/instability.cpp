// SPDX-License-Identifier: MIT
#include <algorithm>

#include "physics/sliding.h"

namespace topple::physics {

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
    // Tipping may find its first release behind a higher pass than its lowest.
    const InstabilityStep* first = tip.curve.empty() ? nullptr : &tip.curve.front();
    result.barrier_J = tip.barrier_J;
    if (tip.release_J > 0 && !(slides && slide.absorbed_J < tip.barrier_J)) {
        result.release_J = tip.release_J;
        result.mode = "tip";
        result.direction = tip.direction;
    } else if (slides && !(first && first->W_J < slide.absorbed_J)) {
        result.barrier_J = slide.absorbed_J;
        result.release_J = slide.released_J;
        result.mode = "slide";
        result.direction = slide.direction;
    } else if (first) {
        result.barrier_J = first->W_J;
        result.release_J = first->S_J;
        result.mode = "tip";
        result.direction = tip.release_direction;
    }
    return result;
}

}  // namespace topple::physics
