// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "core/solid_scene.h"
#include "core/thread_pool.h"
#include "export/clumps.h"
#include "export/convex_part.h"

namespace topple::exports {

// Convex parts of a clump, and how well they fill it.
struct Decomposed {
    std::vector<ConvexPart> parts;
    double solid_m3 = 0;   // of the clump
    double excess_m3 = 0;  // of the parts, beyond that
    bool floor = false;    // its one part is a level slab
};

// Parts are the hulls of pieces of a clump, which are cut along the grid where that takes most of
// what the hull holds beyond the solid, until little is left. One for each clump.
std::vector<Decomposed> decompose(const SolidScene& solids, std::span<const Clump> clumps,
                                  ThreadPool& threads);

}  // namespace topple::exports
