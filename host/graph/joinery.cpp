// SPDX-License-Identifier: MIT
#include "graph/joinery.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/tipping.h"

namespace topple::graph {
namespace {

// Share of the smaller face that the contact covers: below the first it is chance, from the second
// on they mate.
constexpr double by_chance = 0.5, surely = 0.85;
// A load whose centre of mass is this far off what one part carries is not held by it alone.
constexpr double surely_off_m = 0.05;

std::size_t axis_of(const physics::TouchingPair& pair) {
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a)
        if (std::abs(pair.normal[a]) > std::abs(pair.normal[axis])) axis = a;
    return axis;
}

double mated(const ContactGraph& graph, const physics::TouchingPair& pair) {
    const std::size_t axis = axis_of(pair);
    if (axis == 2) return 0;
    const double face = std::min(graph.silhouette_m2[static_cast<std::size_t>(pair.a)][axis],
                                 graph.silhouette_m2[static_cast<std::size_t>(pair.b)][axis]);
    if (!(face > 0)) return 0;
    return std::clamp((pair.area_m2 / face - by_chance) / (surely - by_chance), 0.0, 1.0);
}

// How far the load's centre of mass is off the part's outline, at least over all that carry it;
// 0 where one of them holds it alone.
double off_all(std::span<const Carrying> carriers, const physics::Body& load) {
    double least = std::numeric_limits<double>::infinity();
    for (const Carrying& c : carriers) {
        if (c.outline.empty()) return 0;
        least =
            std::min(least, -physics::footing(c.outline, load.center[0], load.center[1]).margin_m);
    }
    return std::max(least, 0.0);
}

}  // namespace

Joinery::Joinery(const ContactGraph& graph, std::span<const physics::Body> bodies,
                 const SurfaceSeams& seams, const std::vector<bool>& ground) {
    const auto shell = [&](std::int32_t p) { return p < 0 || ground[static_cast<std::size_t>(p)]; };
    for (const auto& [pair, seam] : seams.between)
        raise(pair.first, pair.second, seams.flushness(pair.first, pair.second));
    for (const physics::TouchingPair& pair : graph.pairs) {
        if (!shell(pair.a) && !shell(pair.b)) raise(pair.a, pair.b, mated(graph, pair));
    }
    for (std::int32_t p = 0; p < graph.primitives; ++p) {
        const std::span<const Carrying> carriers = graph.carriers_of(p);
        if (carriers.size() < 2 || shell(p)) continue;
        const double off = off_all(carriers, bodies[static_cast<std::size_t>(p)]);
        for (const Carrying& c : carriers) {
            if (!shell(c.supporter)) raise(c.supporter, p, std::min(off / surely_off_m, 1.0));
        }
    }
}

double Joinery::made_as_one(std::int32_t a, std::int32_t b) const {
    const auto at = one_.find(std::minmax(a, b));
    return at == one_.end() ? 0 : at->second;
}

void Joinery::raise(std::int32_t a, std::int32_t b, double value) {
    if (!(value > 0)) return;
    double& known = one_[std::minmax(a, b)];
    known = std::max(known, value);
}

}  // namespace topple::graph
