// SPDX-License-Identifier: MIT
#include "graph/surface_seams.h"

#include <algorithm>

namespace topple::graph {
namespace {

// Share of a seam along which faces are flush: below the first it is chance, from the second on the
// parts are one piece. A part at an edge of another is flush with it on one to three of four sides.
constexpr double by_chance = 0.15, surely = 0.45;
// A seam of fewer pairs tells nothing.
constexpr std::uint64_t least_pairs = 12;

}  // namespace

double SurfaceSeams::flushness(std::int32_t a, std::int32_t b) const {
    const auto at = between.find(std::minmax(a, b));
    if (at == between.end() || at->second.pairs < least_pairs) return 0;
    const double share =
        static_cast<double>(at->second.flush) / static_cast<double>(at->second.pairs);
    return std::clamp((share - by_chance) / (surely - by_chance), 0.0, 1.0);
}

bool SurfaceSeams::ledged(std::int32_t a, std::int32_t b) const {
    const auto at = between.find(std::minmax(a, b));
    return at != between.end() && at->second.pairs >= least_pairs &&
           2 * at->second.ledge > at->second.pairs;
}

}  // namespace topple::graph
