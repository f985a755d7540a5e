// SPDX-License-Identifier: MIT
#include "graph/pieces.h"

#include <algorithm>
#include <cstddef>
#include <set>

#include "core/union_find.h"
#include "fitted/boosted_trees.h"

namespace topple::graph {

bool WeakestJoint::doubtful() const {
    return probability < doubtful_joint;
}

std::vector<WeakestJoint> weakest_joints(std::span<const Joint> joints, const KnownLinks& links,
                                         std::span<const std::int32_t> object_of_primitive,
                                         std::span<const std::uint64_t> surface,
                                         std::size_t objects) {
    const auto entry = [](auto& list, std::int32_t p) -> auto& {
        return list[static_cast<std::size_t>(p)];
    };
    std::vector<std::uint64_t> whole(objects, 0);
    for (std::size_t p = 0; p < object_of_primitive.size(); ++p)
        whole[static_cast<std::size_t>(object_of_primitive[p])] += surface[p];
    std::vector<Joint> inside;
    for (const Joint& j : joints)
        if (entry(object_of_primitive, j.a) == entry(object_of_primitive, j.b)) inside.push_back(j);
    std::ranges::stable_sort(inside, std::ranges::greater{}, &Joint::log_odds);

    std::vector<WeakestJoint> out(objects);
    UnionFind parts(object_of_primitive.size());
    std::vector<std::uint64_t> seen(surface.begin(), surface.end());
    const auto join = [&](std::size_t a, std::size_t b) {
        const std::uint64_t sum = seen[a] + seen[b];
        parts.join(a, b);
        seen[std::min(a, b)] = sum;
    };
    for (const auto& [p, q] : links.together) {
        const std::size_t a = parts.root(static_cast<std::size_t>(p)),
                          b = parts.root(static_cast<std::size_t>(q));
        if (a != b && entry(object_of_primitive, p) == entry(object_of_primitive, q)) join(a, b);
    }
    for (const Joint& j : inside) {
        const std::size_t a = parts.root(static_cast<std::size_t>(j.a)),
                          b = parts.root(static_cast<std::size_t>(j.b));
        if (a == b) continue;
        const auto o = static_cast<std::size_t>(entry(object_of_primitive, j.a));
        const auto smaller = static_cast<double>(std::min(seen[a], seen[b]));
        if (smaller > 0 && smaller >= least_part * static_cast<double>(whole[o]))
            out[o] = {fitted::probability(j.log_odds), j.a, j.b};
        join(a, b);
    }
    return out;
}

std::vector<PieceOf> likely_pieces(std::span<const Joint> joints, const KnownLinks& links,
                                   std::span<const std::int32_t> object_of_primitive,
                                   std::span<const std::uint64_t> surface) {
    const LinkedNodes nodes(static_cast<std::int32_t>(object_of_primitive.size()), links);
    std::vector<PieceOf> out(surface.size());
    const auto object_of = [&](std::int32_t primitive) {
        return static_cast<std::size_t>(object_of_primitive[static_cast<std::size_t>(primitive)]);
    };
    // Between objects of which somebody said so much, no other joint is asked, either.
    std::set<std::pair<std::size_t, std::size_t>> known;
    for (const auto& [a, b] : links.apart) {
        known.insert({object_of(a), object_of(b)});
        known.insert({object_of(b), object_of(a)});
    }
    for (const Joint& j : joints) {
        const std::size_t a = object_of(j.a), b = object_of(j.b);
        if (a == b || surface[a] == 0 || surface[b] == 0 || nodes.one_object(j.a, j.b) ||
            known.contains({a, b}))
            continue;
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
