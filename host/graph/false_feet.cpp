// SPDX-License-Identifier: MIT
#include "graph/false_feet.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "core/scan_gaps.h"
#include "core/touching_cells.h"
#include "core/union_find.h"

namespace topple::graph {
namespace {

constexpr std::int32_t no_foot = std::numeric_limits<std::int32_t>::max();

// The lowest cell of each object of which the surfaces that bound it leave anything, and its lowest
// cell of all.
struct Ends {
    Table<ObjectId, std::int32_t> solid, lowest;
};
Ends lower_ends(const SolidCells& cells, const BoundaryCells& boundary,
                std::span<const std::int32_t> object, std::size_t objects) {
    Ends out{std::vector(objects, no_foot), std::vector(objects, no_foot)};
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (object[n] < 0) continue;
        const ObjectId o = object[n];
        out.lowest[o] = std::min(out.lowest[o], cells.k[n]);
        if (cells.k[n] >= out.solid[o]) continue;
        const std::size_t b = boundary.find(cells.i[n], cells.j[n], cells.k[n], cells.primitive[n]);
        if (b == BoundaryCells::absent || boundary.share[b] > 0) out.solid[o] = cells.k[n];
    }
    return out;
}

// The lowest cell that was seen of each object, or that hangs together with such: what lies below
// is no foot. Nor is what reaches further than noise does below all that its surfaces leave of it.
Table<ObjectId, std::int32_t> true_feet(const SolidCells& cells, const BoundaryCells& boundary,
                                        std::span<const std::int32_t> object, std::size_t objects) {
    UnionFind pieces(cells.size());
    const auto join = [&](std::size_t m, std::size_t n) {
        if (object[n] >= 0 && object[n] == object[m]) pieces.join(m, n);
    };
    each_touching(cells, join);
    each_across_gaps(cells, noise_gap, join);
    std::vector<bool> seen(cells.size(), false);  // by a piece's root
    for (std::size_t n = 0; n < cells.size(); ++n)
        if (cells.basis[n] == Basis::surface) seen[pieces.root(n)] = true;
    Table<ObjectId, std::int32_t> out(objects, no_foot);
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (object[n] < 0 || !seen[pieces.root(n)]) continue;
        std::int32_t& low = out[object[n]];
        low = std::min(low, cells.k[n]);
    }
    for (std::int32_t& low : out)  // of what was not seen at all there is nothing to tell
        if (low == no_foot) low = std::numeric_limits<std::int32_t>::min();
    const Ends ends = lower_ends(cells, boundary, object, objects);
    for (std::size_t o = 0; o < objects; ++o) {
        const bool solid = ends.solid[o] != no_foot;
        if (solid && std::int64_t{ends.lowest[o]} + noise_gap < ends.solid[o])
            out[o] = std::max(out[o], ends.solid[o]);
    }
    return out;
}

}  // namespace

std::shared_ptr<const SolidScene> without_false_feet(
    const std::shared_ptr<const SolidScene>& solids, ObjectOf object_of_primitive,
    std::int32_t grounded) {
    const auto object_of = [&](PrimitiveId primitive) {
        const ObjectId o = object_of_primitive(primitive);
        return o == grounded ? ObjectId() : o;
    };
    SolidCells cells = solids->cells();
    std::vector<std::int32_t> object;
    for (const std::int32_t p : cells.primitive) object.push_back(object_of(p));
    std::int32_t objects = 0;
    for (const std::int32_t o : object) objects = std::max(objects, o + 1);
    const BoundaryCells& boundary = solids->boundary();
    const auto feet = true_feet(cells, boundary, object, static_cast<std::size_t>(objects));
    bool changed = false;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (object[n] < 0 || cells.k[n] >= feet[object[n]]) continue;
        cells.primitive[n] = -1;
        changed = true;
    }
    if (!changed) return solids;
    // Surfaces pass through one voxel below the lowest cell at most.
    std::vector<bool> kept(boundary.size(), true);
    for (std::size_t b = 0; b < boundary.size(); ++b) {
        const std::int32_t o = object_of(boundary.primitive[b]);
        kept[b] = o < 0 || o >= objects || boundary.k[b] + 1 >= feet[o];
    }
    return std::make_shared<const SolidScene>(std::move(cells), solids->roles(), solids->strays(),
                                              boundary.only(kept));
}

}  // namespace topple::graph
