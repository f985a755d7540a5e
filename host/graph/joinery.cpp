// SPDX-License-Identifier: MIT
#include "graph/joinery.h"

#include <algorithm>
#include <limits>

#include "physics/tipping.h"

namespace topple::graph {
namespace {

// Share of the smaller face that the contact covers: below the first it is chance, from the second
// on they mate. What something below holds may merely stand beside the other.
struct Range {
    double by_chance, surely;
};
constexpr Range standing{0.5, 0.85}, held_by_each_other{0.35, 0.7};
// A load whose centre of mass is this far off what one part carries is not held by it alone.
constexpr double surely_off_m = 0.05;

// By the side on which it is better covered. Faces towards both ways along an axis are the steps of
// a ragged border: the more of them are the contact.
double mated(const ContactGraph& graph, const physics::TouchingPair& pair, const Range& range) {
    // What lies flat on something sinks into its noise, with all its low sides.
    constexpr double least_sideways = 0.5;  // of the contact from above or below
    double covered = 0;
    const double level = std::max(pair.faces[4], pair.faces[5]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
        if (std::max(pair.faces[2 * axis], pair.faces[2 * axis + 1]) < least_sideways * level)
            continue;
        const double face = std::min(graph.bulk_m2[static_cast<std::size_t>(pair.a)][axis],
                                     graph.bulk_m2[static_cast<std::size_t>(pair.b)][axis]);
        const double contact = graph.voxel_m * graph.voxel_m *
                               std::max(pair.faces[2 * axis], pair.faces[2 * axis + 1]);
        if (face > 0) covered = std::max(covered, contact / face);
    }
    return std::clamp((covered - range.by_chance) / (range.surely - range.by_chance), 0.0, 1.0);
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
    std::vector<bool> held;
    std::vector<double> off;
    for (std::int32_t p = 0; p < graph.primitives; ++p) {
        const std::span<const Carrying> carriers = graph.carriers_of(p);
        off.push_back(off_all(carriers, bodies[static_cast<std::size_t>(p)]));
        held.push_back(off.back() == 0 && !carriers.empty());
    }
    for (const physics::TouchingPair& pair : graph.pairs) {
        if (shell(pair.a) || shell(pair.b)) continue;
        const bool both =
            held[static_cast<std::size_t>(pair.a)] && held[static_cast<std::size_t>(pair.b)];
        raise(pair.a, pair.b, mated(graph, pair, both ? standing : held_by_each_other));
    }
    for (const auto& [pair, seam] : seams.between)
        if (seams.ledged(pair.first, pair.second)) one_[pair] = -1;
    for (std::int32_t p = 0; p < graph.primitives; ++p) {
        const std::span<const Carrying> carriers = graph.carriers_of(p);
        if (carriers.size() < 2 || shell(p)) continue;
        const double sure = std::min(off[static_cast<std::size_t>(p)] / surely_off_m, 1.0);
        for (const Carrying& c : carriers)
            if (!shell(c.supporter)) raise(c.supporter, p, sure);
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
