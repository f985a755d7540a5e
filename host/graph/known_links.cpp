// SPDX-License-Identifier: MIT
#include "graph/known_links.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "core/union_find.h"

namespace topple::graph {
namespace {

void make_sorted_set(std::vector<std::int32_t>& values) {
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

// Of each primitive whether links speak of it; see with_others_kept().
Table<PrimitiveId, bool> spoken_of(const KnownLinks& links,
                                   const Table<PrimitiveId, std::int32_t>& group,
                                   std::span<const Joint> joints,
                                   const Table<PrimitiveId, bool>& pinned) {
    std::set<std::int32_t> groups;
    std::vector<PrimitiveId> open;  // of the ground's
    Table<PrimitiveId, bool> out(group.size(), false);
    const auto open_up = [&](PrimitiveId p) {
        if (group[p] >= 0 || pinned[p] || out[p]) return;
        out[p] = true;
        open.push_back(p);
    };
    for (const auto* pairs : {&links.together, &links.apart}) {
        for (const auto& [a, b] : *pairs) {
            for (const PrimitiveId p : {a, b}) {
                if (group[p] >= 0) groups.insert(group[p]);
                open_up(p);
            }
        }
    }
    for (std::size_t p = 0; p < group.size(); ++p)
        if (groups.contains(group[p])) out[p] = true;
    Table<PrimitiveId, std::vector<PrimitiveId>> likely(group.size());
    for (const Joint& j : joints) {
        if (j.log_odds <= 0) continue;
        likely[j.a].push_back(j.b);
        likely[j.b].push_back(j.a);
    }
    while (!open.empty()) {
        const PrimitiveId p = open.back();
        open.pop_back();
        for (const PrimitiveId other : likely[p]) open_up(other);
    }
    return out;
}

}  // namespace

KeptGrouping::KeptGrouping(KnownLinks known, const Table<PrimitiveId, std::int32_t>& group,
                           std::span<const Joint> joints, const Table<PrimitiveId, bool>& pinned)
    : links_(std::move(known)), group_(group), open_(spoken_of(links_, group, joints, pinned)) {
    std::map<std::int32_t, std::int32_t> first;  // primitive of each group that stays
    for (std::size_t p = 0; p < group.size(); ++p) {
        if (open_[p]) continue;
        const auto primitive = static_cast<std::int32_t>(p);
        const auto [at, fresh] = first.try_emplace(group[p], primitive);
        if (!fresh) links_.together.emplace_back(at->second, primitive);
    }
    // Whatever the odds that it is the room's.
    if (const auto ground = first.find(-1); ground != first.end())
        for (const auto& [g, primitive] : first)
            if (g >= 0) links_.apart.emplace_back(ground->second, primitive);
}

std::vector<Joint> KeptGrouping::of_open(std::span<const Joint> joints) const {
    const auto may_change = [this](PrimitiveId p) { return open_[p] || group_[p] < 0; };
    std::vector<Joint> out;
    std::ranges::copy_if(joints, std::back_inserter(out), [&](const Joint& j) {
        return (open_[j.a] || open_[j.b]) && may_change(j.a) && may_change(j.b);
    });
    return out;
}

LinkedNodes::LinkedNodes(std::int32_t primitives, const KnownLinks& links) {
    const auto count = static_cast<std::size_t>(primitives);
    UnionFind sets(count);
    for (const auto& [a, b] : links.together)
        sets.join(PrimitiveId(a).place(), PrimitiveId(b).place());
    std::vector<NodeId> number(count);  // by a set's root
    for (std::size_t p = 0; p < count; ++p) {
        NodeId& node = number[sets.root(p)];
        if (node < 0) {
            node = members_.size();
            members_.emplace_back();
        }
        node_.push_back(node);
        members_[node].push_back(static_cast<std::int32_t>(p));
    }
    if (links.apart.empty()) return;
    apart_.resize(members_.size());
    for (const auto& [a, b] : links.apart) {
        apart_[node_of(a)].push_back(node_of(b));
        apart_[node_of(b)].push_back(node_of(a));
    }
    for (auto& others : apart_) make_sorted_set(others);
}

std::vector<Joint> LinkedNodes::joints(std::span<const Joint> of_primitives) const {
    std::vector<Joint> out;
    for (const Joint& j : of_primitives) {
        const auto [a, b] = std::minmax({node_of(j.a), node_of(j.b)});
        if (a != b) out.push_back({a, b, j.log_odds});
    }
    return out;
}

Table<NodeId, bool> LinkedNodes::pinned(const Table<PrimitiveId, bool>& primitives) const {
    Table<NodeId, bool> out(members_.size(), false);
    for (std::size_t p = 0; p < primitives.size(); ++p)
        if (primitives[p]) out[node_[p]] = true;
    return out;
}

Table<NodeId, double> LinkedNodes::sums(TableView<PrimitiveId, double> of_primitives) const {
    Table<NodeId, double> out(members_.size(), 0);
    for (std::size_t p = 0; p < of_primitives.size(); ++p) out[node_[p]] += of_primitives[p];
    return out;
}

GroupEnergies LinkedNodes::energies(GroupEnergies of_primitives) const {
    if (members_.size() == node_.size()) return of_primitives;
    const auto unfolded = [this](const GroupQuery& query) {
        GroupQuery out{{}, query.pinned};
        for (const std::int32_t node : query.nodes) {
            const auto own = members(node);
            out.nodes.insert(out.nodes.end(), own.begin(), own.end());
        }
        std::ranges::sort(out.nodes);
        return out;
    };
    GroupEnergies out;
    out.of = [unfolded, of = std::move(of_primitives.of)](std::span<const GroupQuery> queries,
                                                          std::span<double> values) {
        std::vector<GroupQuery> all;
        for (const GroupQuery& query : queries) all.push_back(unfolded(query));
        of(all, values);
    };
    for (auto& bound : of_primitives.at_least) {
        out.at_least.emplace_back(
            [unfolded, bound = std::move(bound)](const GroupQuery& query, double before) {
                return bound(unfolded(query), before);
            });
    }
    return out;
}

Table<PrimitiveId, std::int32_t> LinkedNodes::of_primitives(
    TableView<NodeId, std::int32_t> label) const {
    Table<PrimitiveId, std::int32_t> out;
    for (const NodeId node : node_) out.push_back(label[node]);
    return out;
}

std::optional<bool> LinkedNodes::one_object(PrimitiveId a, PrimitiveId b) const {
    if (a != b && node_of(a) == node_of(b)) return true;
    if (!apart_.empty() && std::ranges::binary_search(apart_[node_of(a)], std::int32_t{node_of(b)}))
        return false;
    return std::nullopt;
}

}  // namespace topple::graph
