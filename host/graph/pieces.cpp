// SPDX-License-Identifier: MIT
#include "graph/pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "core/union_find.h"
#include "fitted/boosted_trees.h"

namespace topple::graph {

namespace {

// The joints between two objects that grouping left apart: the likeliest of many tells little, as
// it is chosen by its error; their mean tells best. By a logistic fit on scans of others' models,
// where the objects of one pair in three are one thing.
struct Between {
    double sum = 0;
    std::size_t count = 0;
    Joint likeliest;
    void add(const Joint& j) {
        if (count == 0 || j.log_odds > likeliest.log_odds) likeliest = j;
        sum += j.log_odds;
        ++count;
    }
    double probability() const {
        constexpr double per_log_odds = 1.11, at_zero = -0.41;
        return fitted::probability(per_log_odds * sum / static_cast<double>(count) + at_zero);
    }
};

}  // namespace

bool WeakestJoint::doubtful() const {
    return probability < doubtful_joint;
}

Table<ObjectId, WeakestJoint> weakest_joints(std::span<const Joint> joints, const KnownLinks& links,
                                             ObjectOf object_of,
                                             TableView<PrimitiveId, std::uint64_t> surface,
                                             std::size_t objects) {
    Table<ObjectId, std::uint64_t> whole(objects, 0);
    for (std::size_t p = 0; p < object_of.primitives(); ++p) whole[object_of(p)] += surface[p];
    std::vector<Joint> inside;
    for (const Joint& j : joints)
        if (object_of(j.a) == object_of(j.b)) inside.push_back(j);
    std::ranges::stable_sort(inside, std::ranges::greater{}, &Joint::log_odds);

    Table<ObjectId, WeakestJoint> out(objects);
    UnionFind parts(object_of.primitives());
    std::vector<std::uint64_t> seen(surface.begin(), surface.end());
    const auto join = [&](std::size_t a, std::size_t b) {
        const std::uint64_t sum = seen[a] + seen[b];
        parts.join(a, b);
        seen[std::min(a, b)] = sum;
    };
    const auto part_of = [&](PrimitiveId p) { return parts.root(p.place()); };
    for (const auto& [p, q] : links.together) {
        const std::size_t a = part_of(p), b = part_of(q);
        if (a != b && object_of(p) == object_of(q)) join(a, b);
    }
    for (const Joint& j : inside) {
        const std::size_t a = part_of(j.a), b = part_of(j.b);
        if (a == b) continue;
        const ObjectId o = object_of(j.a);
        const auto smaller = static_cast<double>(std::min(seen[a], seen[b]));
        if (smaller > 0 && smaller >= least_part * static_cast<double>(whole[o]))
            out[o] = {fitted::probability(j.log_odds), j.a, j.b};
        join(a, b);
    }
    return out;
}

std::vector<std::vector<std::int32_t>> both_sides(std::span<const Joint> joints,
                                                  const KnownLinks& links,
                                                  std::span<const std::int32_t> primitives,
                                                  const WeakestJoint& joint) {
    const auto place = [&](std::int32_t p) -> std::optional<std::size_t> {
        const auto at = std::ranges::lower_bound(primitives, p);
        if (at == primitives.end() || *at != p) return std::nullopt;
        return static_cast<std::size_t>(at - primitives.begin());
    };
    const std::size_t a = *place(joint.a), b = *place(joint.b);
    UnionFind parts(primitives.size());
    const auto join = [&](std::int32_t p, std::int32_t q) {
        const auto at = place(p), other = place(q);
        if (!at || !other) return;
        const std::pair sides = std::minmax({parts.root(*at), parts.root(*other)});
        if (sides != std::minmax({parts.root(a), parts.root(b)}))
            parts.join(sides.first, sides.second);
    };
    for (const auto& [p, q] : links.together) join(p, q);
    std::vector<Joint> likeliest_first;
    std::ranges::copy_if(joints, std::back_inserter(likeliest_first),
                         [&](const Joint& j) { return place(j.a) && place(j.b); });
    std::ranges::stable_sort(likeliest_first, std::ranges::greater{}, &Joint::log_odds);
    for (const Joint& j : likeliest_first) join(j.a, j.b);
    std::vector<std::vector<std::int32_t>> out(2);
    for (std::size_t n = 0; n < primitives.size(); ++n)
        out[parts.root(n) == parts.root(b) ? 1 : 0].push_back(primitives[n]);
    return out;
}

Table<ObjectId, PieceOf> likely_pieces(std::span<const Joint> joints, const KnownLinks& links,
                                       ObjectOf object_of,
                                       TableView<ObjectId, std::uint64_t> surface) {
    const LinkedNodes nodes(static_cast<std::int32_t>(object_of.primitives()), links);
    // Between objects of which somebody said so much, no other joint is asked, either.
    std::set<std::pair<ObjectId, ObjectId>> known;
    for (const auto& [a, b] : links.apart) known.insert(std::minmax(object_of(a), object_of(b)));
    std::map<std::pair<ObjectId, ObjectId>, Between> between;
    for (const Joint& j : joints) {
        const ObjectId a = object_of(j.a), b = object_of(j.b);
        if (a == b || surface[a] == 0 || surface[b] == 0 || nodes.one_object(j.a, j.b)) continue;
        if (!known.contains(std::minmax(a, b))) between[std::minmax(a, b)].add(j);
    }
    Table<ObjectId, PieceOf> out(surface.size());
    for (const auto& [objects, all] : between) {
        const double probability = all.probability();
        const auto may_be = [&](ObjectId piece, ObjectId whole) {
            const PrimitiveId a = all.likeliest.a, b = all.likeliest.b;
            if (surface[piece] <= surface[whole] && probability > out[piece].probability)
                out[piece] = {probability, object_of(a) == whole ? a : b};
        };
        may_be(objects.first, objects.second);
        may_be(objects.second, objects.first);
    }
    return out;
}

double whole_probability(const PieceOf& piece, const WeakestJoint& weakest, std::uint64_t voxels) {
    constexpr auto columns = std::to_array<std::string_view>({"piece", "joint", "log_voxels"});
    const std::array row{static_cast<float>(piece.probability),
                         static_cast<float>(weakest.probability),
                         static_cast<float>(std::log1p(static_cast<double>(voxels)))};
    return fitted::probability(fitted::whole_model(columns).log_odds(row));
}

}  // namespace topple::graph
