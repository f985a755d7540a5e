// SPDX-License-Identifier: MIT
#include "graph/greedy_contraction.h"

#include <algorithm>
#include <map>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include "core/union_find.h"

namespace topple::graph {
namespace {

class Contraction {
  public:
    Contraction(std::int32_t nodes, std::span<const Joint> joints,
                const Table<NodeId, bool>& pinned, TableView<NodeId, double> to_pinned,
                TableView<NodeId, std::vector<std::int32_t>> apart)
        : sets_(static_cast<std::size_t>(nodes)),
          between_(static_cast<std::size_t>(nodes)),
          apart_(apart.size()) {
        NodeId ground;
        for (std::int32_t n = 0; n < nodes; ++n) {
            if (!pinned[n]) continue;
            if (ground < 0) ground = n;
            sets_.join(ground.place(), NodeId(n).place());
        }
        for (std::size_t n = 0; n < apart.size(); ++n) {
            for (const std::int32_t other : apart[n]) apart_[root(n)].insert(root(other));
        }
        for (const Joint& joint : joints) add(root(joint.a), root(joint.b), joint.log_odds);
        for (std::int32_t n = 0; n < nodes && ground >= 0; ++n)
            add(n, root(n) == ground ? NodeId(n) : ground, to_pinned[n]);
        for (std::int32_t n = 0; n < nodes; ++n) {
            for (const auto& [other, sum] : at(n))
                if (other > n) offer(n, other, sum);
        }
    }

    Table<NodeId, std::int32_t> run() {
        while (!open_.empty()) {
            const auto [sum, minus_a, minus_b] = open_.top();
            open_.pop();
            const std::int32_t a = -minus_a, b = -minus_b;
            if (root(a) != a || root(b) != b) continue;
            const auto now = at(a).find(b);
            if (now == at(a).end() || now->second != sum) continue;  // an older offer
            if (kept_apart(a, b)) continue;
            join(a, b);
        }
        Table<NodeId, std::int32_t> label;
        for (std::int32_t n = 0; n < static_cast<std::int32_t>(between_.size()); ++n)
            label.push_back(root(n));
        return label;
    }

  private:
    std::map<std::int32_t, double>& at(NodeId n) { return between_[n]; }
    NodeId root(NodeId n) { return sets_.root(n.place()); }
    void add(std::int32_t a, std::int32_t b, double log_odds) {
        if (a == b) return;
        at(a)[b] += log_odds;
        at(b)[a] += log_odds;
    }
    void offer(std::int32_t a, std::int32_t b, double sum) {
        if (sum > 0) open_.emplace(sum, -std::min(a, b), -std::max(a, b));
    }
    bool kept_apart(std::int32_t a, std::int32_t b) const {
        return !apart_.empty() && apart_[a].contains(b);
    }
    // b joins a, which is the lower.
    void join(NodeId a, NodeId b) {
        sets_.join(a.place(), b.place());
        if (!apart_.empty()) {
            for (const std::int32_t other : apart_[b]) {
                apart_[other].erase(b);
                apart_[other].insert(a);
                apart_[a].insert(other);
            }
        }
        at(a).erase(b);
        for (const auto& [other, sum] : at(b)) {
            if (other == a) continue;
            at(other).erase(b);
            const double both = at(a)[other] += sum;
            at(other)[a] = both;
            offer(a, other, both);
        }
        at(b).clear();
    }

    UnionFind sets_;
    Table<NodeId, std::map<std::int32_t, double>> between_;
    Table<NodeId, std::set<std::int32_t>> apart_;  // by root, other roots; or empty
    // (sum, -a, -b): the largest sum first, then the lowest nodes.
    std::priority_queue<std::tuple<double, std::int32_t, std::int32_t>> open_;
};

}  // namespace

Table<NodeId, std::int32_t> contract_greedily(std::int32_t nodes, std::span<const Joint> joints,
                                              const Table<NodeId, bool>& pinned,
                                              TableView<NodeId, double> to_pinned,
                                              TableView<NodeId, std::vector<std::int32_t>> apart) {
    return Contraction(nodes, joints, pinned, to_pinned, apart).run();
}

}  // namespace topple::graph
