// SPDX-License-Identifier: MIT
#include "lab/evaluation/greedy.h"

#include <algorithm>
#include <map>
#include <utility>

namespace topple::evaluation {
namespace {

using graph::GroupQuery;

// Groups are known by their lowest node.
class Pursuit {
  public:
    Pursuit(std::int32_t nodes, std::span<const graph::Edge> edges, const std::vector<bool>& pinned,
            const EnergyOf& energy_of)
        : edges_(edges), pinned_(pinned), energy_of_(energy_of) {
        const auto first = std::ranges::find(pinned, true) - pinned.begin();
        ground_ = static_cast<std::int32_t>(first);
        for (std::int32_t n = 0; n < nodes; ++n) of_.push_back(pinned[at(n)] ? ground_ : n);
    }

    GreedyPartition run() {
        std::map<Pair, double> joined;  // energies of touching groups' unions
        for (Pair best{-1, -1};; best = {-1, -1}) {
            ask(joined);
            double most = 0;
            for (const auto& [pair, energy] : joined) {
                const double lowered = alone_.at(pair.first) + alone_.at(pair.second) - energy;
                if (lowered <= most) continue;
                most = lowered;
                best = pair;
            }
            if (best.first < 0) return result();
            alone_[best.first] = joined.at(best);
            alone_.erase(best.second);
            std::ranges::replace(of_, best.second, best.first);
            std::erase_if(joined, [&](const auto& one) {
                const auto [a, b] = one.first;
                return a == best.first || a == best.second || b == best.first || b == best.second;
            });
        }
    }

  private:
    using Pair = std::pair<std::int32_t, std::int32_t>;
    static std::size_t at(std::int32_t n) { return static_cast<std::size_t>(n); }

    GroupQuery query(std::int32_t a, std::int32_t b) const {
        GroupQuery out{{}, false};
        for (std::int32_t n = 0; n < static_cast<std::int32_t>(of_.size()); ++n) {
            if (of_[at(n)] != a && of_[at(n)] != b) continue;
            out.nodes.push_back(n);
            out.pinned = out.pinned || pinned_[at(n)];
        }
        return out;
    }
    // Adds the energies that are not known yet, of groups and of what touches.
    void ask(std::map<Pair, double>& joined) {
        std::vector<GroupQuery> queries;
        std::vector<double*> answers;
        const auto want = [&](double& energy, std::int32_t a, std::int32_t b) {
            queries.push_back(query(a, b));
            answers.push_back(&energy);
        };
        for (const std::int32_t group : of_)
            if (const auto [one, fresh] = alone_.try_emplace(group); fresh)
                want(one->second, group, group);
        for (const graph::Edge& e : edges_) {
            const Pair pair = std::minmax(of_[at(e.a)], of_[at(e.b)]);
            if (pair.first == pair.second) continue;
            if (const auto [one, fresh] = joined.try_emplace(pair); fresh)
                want(one->second, pair.first, pair.second);
        }
        std::vector<double> energy(queries.size());
        if (!queries.empty()) energy_of_(queries, energy);
        for (std::size_t n = 0; n < energy.size(); ++n) *answers[n] = energy[n];
    }
    GreedyPartition result() const {
        GreedyPartition out;
        std::map<std::int32_t, std::int32_t> label;
        std::int32_t next = 0;
        for (const auto& [group, energy] : alone_) {
            out.energy += energy;
            label[group] = at(ground_) < of_.size() && group == of_[at(ground_)] ? -1 : next++;
        }
        for (const std::int32_t group : of_) out.label.push_back(label.at(group));
        return out;
    }

    std::span<const graph::Edge> edges_;
    const std::vector<bool>& pinned_;
    const EnergyOf& energy_of_;
    std::int32_t ground_ = 0;               // the first that is pinned
    std::vector<std::int32_t> of_;          // the group of each node
    std::map<std::int32_t, double> alone_;  // energy of each group
};

}  // namespace

GreedyPartition greedy_merges(std::int32_t nodes, std::span<const graph::Edge> edges,
                              const std::vector<bool>& pinned, const EnergyOf& energy_of) {
    return Pursuit(nodes, edges, pinned, energy_of).run();
}

}  // namespace topple::evaluation
