// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "core/solid_scene.h"
#include "core/thread_pool.h"
#include "export/convex_part.h"

namespace topple::exports {

// Convex parts of a primitive, and how well they fill it.
struct Decomposed {
    std::vector<ConvexPart> parts;
    double solid_m3 = 0;   // of the primitive
    double excess_m3 = 0;  // of the parts, beyond that
};

// Parts are the hulls of pieces of a primitive, which are cut along the grid where that takes most
// of what the hull holds beyond the solid, until little is left. slight_m3: by primitive, what a
// piece's hull may hold beyond it; below 0: the primitive is not wanted.
std::vector<Decomposed> decompose(const SolidScene& solids, std::span<const double> slight_m3,
                                  ThreadPool& threads);

}  // namespace topple::exports
