// SPDX-License-Identifier: MIT
#include "graph/pieces.h"

#include <cstddef>

#include "fitted/boosted_trees.h"

namespace topple::graph {

std::vector<PieceOf> likely_pieces(std::span<const Joint> joints, const KnownLinks& links,
                                   std::span<const std::int32_t> object_of_primitive,
                                   std::span<const std::uint64_t> surface) {
    const LinkedNodes nodes(static_cast<std::int32_t>(object_of_primitive.size()), links);
    std::vector<PieceOf> out(surface.size());
    const auto object_of = [&](std::int32_t primitive) {
        return static_cast<std::size_t>(object_of_primitive[static_cast<std::size_t>(primitive)]);
    };
    for (const Joint& j : joints) {
        const std::size_t a = object_of(j.a), b = object_of(j.b);
        if (a == b || surface[a] == 0 || surface[b] == 0 || nodes.one_object(j.a, j.b)) continue;
        const double probability = fitted::probability(j.log_odds);
        const auto may_be = [&](std::size_t piece, std::size_t whole, std::int32_t primitive) {
            if (surface[piece] <= surface[whole] && probability > out[piece].probability)
                out[piece] = {probability, primitive};
        };
        may_be(a, b, j.b);
        may_be(b, a, j.a);
    }
    return out;
}

}  // namespace topple::graph
