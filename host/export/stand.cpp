// SPDX-License-Identifier: MIT
#include "export/stand.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/vectors.h"
#include "export/separate.h"
#include "physics/infinity.h"

namespace topple::exports {
namespace {

constexpr double level_cosine = 0.9;  // of a side that carries

// Calls use(part of the body, part below it, how they lie) for all that come within a distance of
// one another, one over the other.
template <class Use>
void each_footing(std::vector<Body>& bodies, Body& body, double within_m, const Use& use) {
    for (const std::int32_t carrier : body.carried_by) {
        for (const ConvexPart& below : bodies[carrier].parts) {
            for (ConvexPart& part : body.parts) {
                if (!near(part, below, within_m)) continue;
                const Apart lie = apart(below, part);
                if (lie.normal[2] >= level_cosine && lie.gap_m <= within_m) use(part, below, lie);
            }
        }
    }
}

void move(Body& body, const Vec3& by) {
    for (ConvexPart& part : body.parts) part = moved(std::move(part), by);
    body.center_m = along(body.center_m, 1, by);
    body.moved_m = along(body.moved_m, 1, by);
}

}  // namespace

std::vector<std::size_t> by_level(const std::vector<Body>& bodies) {
    std::vector<std::size_t> order(bodies.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t n) { return bodies[n].level; });
    return order;
}

void settle(std::vector<Body>& bodies, double most_m) {
    for (const std::size_t n : by_level(bodies)) {
        Body& body = bodies[n];
        if (body.fixed) continue;
        double gap = physics::infinity;
        each_footing(bodies, body, most_m,
                     [&](const ConvexPart&, const ConvexPart&, const Apart& lie) {
                         gap = std::min(gap, lie.gap_m);
                     });
        if (gap > 0 && gap < physics::infinity) move(body, {0, 0, -gap});
    }
}

}  // namespace topple::exports
