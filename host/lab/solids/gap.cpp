// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/solids/part.h"

namespace topple::scenes {
namespace {

Vec3 add(const Vec3& a, const Vec3& b, double scale) {
    return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}

// max of two convex functions, by subgradient steps; both gradients have length 1. Steps shrink
// geometrically, and the best value seen is kept.
double least_common_distance(const Part& a, const Part& b, double tolerance) {
    Vec3 p = add(a.center, add(b.center, a.center, -1), 0.5);
    const double scale = a.bounding_radius() + b.bounding_radius();
    double best = std::numeric_limits<double>::infinity();
    for (double step = scale; step > tolerance / 4; step *= 0.97) {
        const double da = a.distance(p), db = b.distance(p);
        best = std::min(best, std::max(da, db));
        const Vec3 na = a.normal(p), nb = b.normal(p);
        // Near the tie both matter: alternating between them walks along the crease.
        p = add(p, da > db ? na : nb, -std::min(step, std::max(std::abs(da - db), step / 2)));
    }
    return best;
}

}  // namespace

double gap(const Part& a, const Part& b, double tolerance) {
    return 2 * least_common_distance(a.hull(), b.hull(), tolerance);
}

}  // namespace topple::scenes
