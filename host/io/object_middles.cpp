// SPDX-License-Identifier: MIT
#include "io/object_middles.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace topple::io {

std::vector<std::optional<Vec3>> object_middles_m(const Scene& scene) {
    constexpr double far = std::numeric_limits<double>::infinity();
    struct Ends {
        Vec3 low{far, far, far}, high{-far, -far, -far};
    };
    const auto& turn = scene.manhattan_from_input;
    const SolidVoxels& solid = scene.solid;
    std::vector<Ends> ends(scene.objects.size());
    for (std::size_t v = 0; v < solid.x.size(); ++v) {
        const auto o = static_cast<std::size_t>(solid.object[v]);
        if (solid.object[v] < 0 || o >= ends.size()) continue;
        for (std::size_t a = 0; a < 3; ++a) {
            const double place = turn[4 * a] * solid.x[v] + turn[4 * a + 1] * solid.y[v] +
                                 turn[4 * a + 2] * solid.z[v];
            ends[o].low[a] = std::min(ends[o].low[a], place);
            ends[o].high[a] = std::max(ends[o].high[a], place);
        }
    }
    std::vector<std::optional<Vec3>> out(scene.objects.size());
    for (std::size_t o = 0; o < ends.size(); ++o) {
        if (!(ends[o].low[0] <= ends[o].high[0])) continue;
        Vec3 middle{};  // a rotation's inverse is its transpose
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b)
                middle[b] += turn[4 * a + b] * 0.5 * (ends[o].low[a] + ends[o].high[a]);
        out[o] = middle;
    }
    return out;
}

}  // namespace topple::io
