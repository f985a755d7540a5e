// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace topple::geometry {

// What the seen surface tells of primitives and of the seams between them: sums over pairs of
// neighbouring surface elements.
struct Seam {
    double variation = 0;     // of 1 - n.n'
    std::uint64_t pairs = 0;  // all of them
    std::uint64_t flush = 0;  // those where the surface goes on smoothly
    std::uint64_t ledge = 0;  // those with a ledge between (geometry/ledges.h)
};
struct SurfaceSeams {
    std::vector<Seam> inside;                                       // by primitive
    std::map<std::pair<std::int32_t, std::int32_t>, Seam> between;  // (a, b), a < b
};

}  // namespace topple::geometry
