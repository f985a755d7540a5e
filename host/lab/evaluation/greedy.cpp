// SPDX-License-Identifier: MIT
#include "lab/evaluation/greedy.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace topple::evaluation {
namespace {

using graph::Group;
using graph::GroupQuery;

class Pursuit {
  public:
    Pursuit(std::int32_t nodes, std::span<const graph::Edge> edges, const std::vector<bool>& pinned,
            const EnergyOf& energy_of)
        : energy_of_(energy_of) {
        std::int32_t ground = -1;
        for (std::int32_t n = 0; n < nodes; ++n) {
            const bool is_pinned = pinned[static_cast<std::size_t>(n)];
            if (is_pinned && ground >= 0) {
                group_[ground].nodes.push_back(n);
                of_.push_back(ground);
                continue;
            }
            if (is_pinned) ground = n;
            group_[n] = {{n}, is_pinned};
            of_.push_back(n);
        }
        for (const graph::Edge& e : edges) {
            const auto pair =
                std::minmax(of_[static_cast<std::size_t>(e.a)], of_[static_cast<std::size_t>(e.b)]);
            if (pair.first != pair.second) touching_.insert(pair);
        }
        std::vector<GroupQuery> all;
        for (const auto& [id, query] : group_) all.push_back(query);
        const std::vector<double> value = ask(all);
        std::size_t at = 0;
        for (const auto& [id, query] : group_) energy_[id] = value[at++];
        gain(touching_);
    }

    GreedyPartition run() {
        for (;;) {
            std::pair<std::int32_t, std::int32_t> best;
            double most = 0;
            for (const auto& [pair, union_energy] : union_) {
                const double lowered =
                    energy_.at(pair.first) + energy_.at(pair.second) - union_energy;
                if (lowered <= most) continue;
                most = lowered;
                best = pair;
            }
            if (!(most > 0)) break;
            join(best.first, best.second);
        }
        return result();
    }

  private:
    std::vector<double> ask(const std::vector<GroupQuery>& queries) const {
        std::vector<double> value(queries.size());
        if (!queries.empty()) energy_of_(queries, value);
        return value;
    }
    GroupQuery joined(std::int32_t a, std::int32_t b) const {
        const GroupQuery &x = group_.at(a), &y = group_.at(b);
        GroupQuery out{{}, x.pinned || y.pinned};
        std::ranges::merge(x.nodes, y.nodes, std::back_inserter(out.nodes));
        return out;
    }
    void gain(const std::set<std::pair<std::int32_t, std::int32_t>>& pairs) {
        std::vector<GroupQuery> queries;
        for (const auto& [a, b] : pairs) queries.push_back(joined(a, b));
        const std::vector<double> value = ask(queries);
        std::size_t at = 0;
        for (const auto& pair : pairs) union_[pair] = value[at++];
    }
    // Groups are known by their lowest node.
    void join(std::int32_t a, std::int32_t b) {
        energy_[a] = union_.at({a, b});
        energy_.erase(b);
        group_[a] = joined(a, b);
        group_.erase(b);
        std::set<std::pair<std::int32_t, std::int32_t>> fresh;
        for (auto at = union_.begin(); at != union_.end();) {
            const auto [x, y] = at->first;
            if (x != a && x != b && y != a && y != b) {
                ++at;
                continue;
            }
            const std::int32_t other = x == a || x == b ? y : x;
            if (other != a && other != b) fresh.insert(std::minmax(a, other));
            at = union_.erase(at);
        }
        gain(fresh);
    }
    GreedyPartition result() const {
        GreedyPartition out;
        out.label.resize(of_.size());
        std::int32_t next = 0;
        for (const auto& [id, query] : group_) {
            out.energy += energy_.at(id);
            const std::int32_t label = query.pinned ? -1 : next++;
            for (const std::int32_t n : query.nodes) out.label[static_cast<std::size_t>(n)] = label;
        }
        return out;
    }

    const EnergyOf& energy_of_;
    std::vector<std::int32_t> of_;  // first group of each node
    std::map<std::int32_t, GroupQuery> group_;
    std::map<std::int32_t, double> energy_;  // of each group
    std::set<std::pair<std::int32_t, std::int32_t>> touching_;
    std::map<std::pair<std::int32_t, std::int32_t>, double>
        union_;  // energy of touching groups' unions
};

}  // namespace

GreedyPartition greedy_merges(std::int32_t nodes, std::span<const graph::Edge> edges,
                              const std::vector<bool>& pinned, const EnergyOf& energy_of) {
    return Pursuit(nodes, edges, pinned, energy_of).run();
}

}  // namespace topple::evaluation
