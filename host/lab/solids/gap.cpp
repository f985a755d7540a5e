// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/vectors.h"
#include "lab/solids/part.h"

namespace topple::scenes {
namespace {

// max of two convex functions, by subgradient steps; both gradients have length 1. Steps shrink
// geometrically, and the best value seen is kept.
double least_common_distance(const Part& a, const Part& b, double tolerance) {
    Vec3 p = along(a.center, 0.5, minus(b.center, a.center));
    const double scale = a.bounding_radius() + b.bounding_radius();
    double best = std::numeric_limits<double>::infinity();
    for (double step = scale; step > tolerance / 4; step *= 0.97) {
        const double da = a.distance(p), db = b.distance(p);
        best = std::min(best, std::max(da, db));
        const Vec3 na = a.normal(p), nb = b.normal(p);
        // Near the tie both matter: alternating between them walks along the crease.
        const double back = std::min(step, std::max(std::abs(da - db), step / 2));
        p = along(p, -back, da > db ? na : nb);
    }
    return best;
}

}  // namespace

double gap(const Part& a, const Part& b, double tolerance) {
    return 2 * least_common_distance(a.hull(), b.hull(), tolerance);
}

}  // namespace topple::scenes
