// SPDX-License-Identifier: MIT
#include "export/stand.h"

#include <algorithm>
#include <numeric>

#include "core/vectors.h"
#include "export/separate.h"
#include "physics/infinity.h"

namespace topple::exports {
namespace {

constexpr double level_cosine = 0.9;  // of a side that carries

// The least gap between a body and what carries it, of parts that lie one over the other and no
// further apart than that; infinity without any.
double gap_m(const std::vector<Body>& bodies, const Body& body, double within_m) {
    double gap = physics::infinity;
    for (const std::int32_t carrier : body.carried_by) {
        for (const ConvexPart& below : bodies[carrier].parts) {
            for (const ConvexPart& part : body.parts) {
                if (!near(part, below, within_m)) continue;
                const Apart lie = apart(below, part);
                if (lie.normal[2] >= level_cosine && lie.gap_m <= within_m)
                    gap = std::min(gap, lie.gap_m);
            }
        }
    }
    return gap;
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
        const double gap = gap_m(bodies, body, most_m);
        if (gap > 0 && gap < physics::infinity) move(body, {0, 0, -gap});
    }
}

}  // namespace topple::exports
