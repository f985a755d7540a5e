// SPDX-License-Identifier: MIT
#include "graph/swendsen_wang.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_map>

#include "core/random.h"

namespace topple::graph {
namespace {

constexpr std::int32_t pinned_label = 0;

// The graph as each node sees it: CSR of (neighbour, edge).
struct Adjacency {
    std::vector<std::size_t> first;
    std::vector<std::int32_t> node;
    std::vector<std::size_t> edge;

    Adjacency(std::int32_t nodes, std::span<const Edge> edges)
        : first(static_cast<std::size_t>(nodes) + 1) {
        for (const Edge& e : edges) {
            ++first[static_cast<std::size_t>(e.a) + 1];
            ++first[static_cast<std::size_t>(e.b) + 1];
        }
        std::partial_sum(first.begin(), first.end(), first.begin());
        node.resize(first.back());
        edge.resize(first.back());
        std::vector<std::size_t> next(first.begin(), first.end() - 1);
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const auto link = [&](std::int32_t from, std::int32_t to) {
                const std::size_t at = next[static_cast<std::size_t>(from)]++;
                node[at] = to;
                edge[at] = i;
            };
            link(edges[i].a, edges[i].b);
            link(edges[i].b, edges[i].a);
        }
    }
};

struct HashOfQuery {
    std::size_t operator()(const GroupQuery& q) const {
        std::uint64_t h = q.pinned ? 0x9E3779B97F4A7C15u : 0;
        for (const std::int32_t n : q.nodes)
            h = (h ^ static_cast<std::uint64_t>(n)) * 0xD6E8FEB86659FD93u + (h >> 32);
        return h;
    }
};
struct SameQuery {
    bool operator()(const GroupQuery& a, const GroupQuery& b) const {
        return a.pinned == b.pinned && a.nodes == b.nodes;
    }
};

// Energies by group, asked for once each.
class EnergyCache {
  public:
    explicit EnergyCache(const GroupEnergies& energies) : energies_(energies) {}

    // Makes sure that all queries are known, in one call for those that aren't.
    void fetch(std::span<const GroupQuery> queries) {
        std::vector<GroupQuery> missing;
        for (const GroupQuery& q : queries) {
            if (q.nodes.empty()) continue;
            Energy& known = known_[q];
            if (known.exact) continue;
            known.exact = true;
            missing.push_back(q);
        }
        if (missing.empty()) return;
        std::vector<double> values(missing.size());
        energies_.of(missing, values);
        for (std::size_t i = 0; i < missing.size(); ++i) known_[missing[i]].value = values[i];
        evaluated_ += missing.size();
    }
    double operator()(const GroupQuery& q) const {
        return q.nodes.empty() ? 0 : known_.at(q).value;
    }
    double at_least(const GroupQuery& q) {
        if (q.nodes.empty()) return 0;
        const auto [at, fresh] = known_.try_emplace(q);
        if (fresh && energies_.at_least) at->second.value = energies_.at_least(q);
        return at->second.value;
    }
    std::uint64_t evaluated() const { return evaluated_; }

  private:
    struct Energy {
        double value = -std::numeric_limits<double>::infinity();  // or a lower bound
        bool exact = false;
    };
    const GroupEnergies& energies_;
    std::unordered_map<GroupQuery, Energy, HashOfQuery, SameQuery> known_;
    std::uint64_t evaluated_ = 0;
};

// A flip that awaits its energies.
struct Proposal {
    bool open = false;  // neither rejected nor without effect, so far
    std::vector<std::int32_t> moved;
    std::int32_t from = 0, to = 0;
    double log_cut_ratio = 0;  // ln of the products of (1 - q_e) in Eq. 11
    double most_change = 0;    // of the energy, exclusive, for which it is accepted
    GroupQuery from_after, to_after;
};

class Chain {
  public:
    Chain(std::int32_t nodes, std::span<const Edge> edges, const Adjacency& adjacency,
          const std::vector<bool>& pinned, Random random)
        : edges_(edges), adjacency_(adjacency), pinned_(pinned), random_(random) {
        label_.resize(static_cast<std::size_t>(nodes));
        members_.resize(static_cast<std::size_t>(nodes) + 1);
        for (std::int32_t n = 0; n < nodes; ++n) {
            const std::int32_t l = pinned_[static_cast<std::size_t>(n)] ? pinned_label : n + 1;
            label_[static_cast<std::size_t>(n)] = l;
            members_[static_cast<std::size_t>(l)].push_back(n);
        }
    }

    std::vector<GroupQuery> groups() const {
        std::vector<GroupQuery> all;
        for (std::size_t l = 0; l < members_.size(); ++l) {
            if (!members_[l].empty()) all.push_back({members_[l], l == pinned_label});
        }
        return all;
    }
    // Energies of the groups, which the cache knows.
    void start(const EnergyCache& energy_of) {
        energy_of_label_.assign(members_.size(), 0);
        energy_ = 0;
        for (std::size_t l = 0; l < members_.size(); ++l) {
            energy_of_label_[l] = energy_of({members_[l], l == pinned_label});
            energy_ += energy_of_label_[l];
        }
    }
    double energy() const { return energy_; }
    const std::vector<std::int32_t>& labels() const { return label_; }

    // Draws a flip and the odds it must meet; whether it can be accepted as far as `energies` tell.
    const Proposal& propose(EnergyCache& energies, double temperature) {
        draw();
        // Drawn always, so that the stream of random numbers doesn't depend on the outcome.
        const double u = random_.uniform();
        Proposal& p = proposal_;
        if (!p.open) return p;
        // Metropolis-Hastings, Eq. 11: ln u < ln ratio - change / T.
        p.most_change = temperature * (p.log_cut_ratio -
                                       std::log(std::max(u, std::numeric_limits<double>::min())));
        p.open =
            change(energies.at_least(p.from_after), energies.at_least(p.to_after)) < p.most_change;
        return p;
    }

    void decide(const EnergyCache& energy_of) {
        const Proposal& p = proposal_;
        if (!p.open) return;
        const double from = energy_of(p.from_after), to = energy_of(p.to_after);
        if (change(from, to) >= p.most_change) return;
        energy_ += change(from, to);
        for (const std::int32_t n : p.moved) label_[static_cast<std::size_t>(n)] = p.to;
        members_[static_cast<std::size_t>(p.from)] = p.from_after.nodes;
        members_[static_cast<std::size_t>(p.to)] = p.to_after.nodes;
        energy_of_label_[static_cast<std::size_t>(p.from)] = from;
        energy_of_label_[static_cast<std::size_t>(p.to)] = to;
    }

  private:
    double change(double from_after, double to_after) const {
        return from_after + to_after - energy_of_label_[static_cast<std::size_t>(proposal_.from)] -
               energy_of_label_[static_cast<std::size_t>(proposal_.to)];
    }

    void draw() {
        proposal_ = {};
        if (label_.empty()) return;
        grow_component(static_cast<std::int32_t>(random_.below(label_.size())));
        Proposal& p = proposal_;
        for (const std::int32_t n : p.moved) {
            if (pinned_[static_cast<std::size_t>(n)]) return;
        }
        choose_target();
        if (p.to == p.from) return;
        const Group& from = members_[static_cast<std::size_t>(p.from)];
        const Group& to = members_[static_cast<std::size_t>(p.to)];
        p.from_after.pinned = p.from == pinned_label;
        std::set_difference(from.begin(), from.end(), p.moved.begin(), p.moved.end(),
                            std::back_inserter(p.from_after.nodes));
        if (!connected(p.from_after)) return;
        p.open = true;
        p.to_after.pinned = p.to == pinned_label;
        std::merge(to.begin(), to.end(), p.moved.begin(), p.moved.end(),
                   std::back_inserter(p.to_after.nodes));
    }

    // The connected component of turned-on edges around one node. Edges are drawn as they are met,
    // each at most once: the same distribution as drawing all of them first. Starting from a random
    // node picks a component with probability proportional to its size, which is the same in the
    // state before and after the flip, and so cancels in Eq. 11 as a uniform choice would.
    void grow_component(std::int32_t seed) {
        Proposal& p = proposal_;
        p.from = label_[static_cast<std::size_t>(seed)];
        std::vector<bool> inside(label_.size()), drawn(edges_.size());
        inside[static_cast<std::size_t>(seed)] = true;
        p.moved.push_back(seed);
        for (std::size_t head = 0; head < p.moved.size(); ++head) {
            for_links(p.moved[head], [&](std::int32_t to, std::size_t e) {
                if (label_[static_cast<std::size_t>(to)] != p.from || drawn[e]) return;
                drawn[e] = true;
                const bool on = random_.uniform() < edges_[e].turn_on;
                if (on && !inside[static_cast<std::size_t>(to)]) {
                    inside[static_cast<std::size_t>(to)] = true;
                    p.moved.push_back(to);
                }
            });
        }
        std::sort(p.moved.begin(), p.moved.end());
    }

    // The target is one of the groups that touch the component from outside, or a fresh group, each
    // alike. The nodes outside keep their labels, so the reverse flip has the same choices and the
    // proposal's own ratio q(old)/q(new) is 1.
    void choose_target() {
        Proposal& p = proposal_;
        std::vector<std::int32_t> targets;
        for (const std::int32_t n : p.moved) {
            for_links(n, [&](std::int32_t to, std::size_t) {
                if (!std::binary_search(p.moved.begin(), p.moved.end(), to)) {
                    targets.push_back(label_[static_cast<std::size_t>(to)]);
                }
            });
        }
        std::sort(targets.begin(), targets.end());
        targets.erase(std::unique(targets.begin(), targets.end()), targets.end());
        const std::uint64_t pick = random_.below(targets.size() + 1);
        if (pick == targets.size()) {
            // A fresh group; where the component already is a whole group, that is no change.
            const bool whole = members_[static_cast<std::size_t>(p.from)].size() == p.moved.size();
            p.to = whole ? p.from : free_label();
        } else {
            p.to = targets[pick];
        }
        if (p.to == p.from) return;
        for (const std::int32_t n : p.moved) {
            for_links(n, [&](std::int32_t to, std::size_t e) {
                if (std::binary_search(p.moved.begin(), p.moved.end(), to)) return;
                const std::int32_t l = label_[static_cast<std::size_t>(to)];
                if (l == p.to) p.log_cut_ratio += std::log1p(-edges_[e].turn_on);
                if (l == p.from) p.log_cut_ratio -= std::log1p(-edges_[e].turn_on);
            });
        }
    }

    // A group is one rigid body, so it hangs together; the pinned nodes do so by definition. Flips
    // that would break a group are not proposed, which also keeps every flip reversible.
    bool connected(const GroupQuery& group) const {
        if (group.nodes.size() < 2) return true;
        std::vector<bool> reached(label_.size());
        std::vector<std::int32_t> open;
        const auto reach = [&](std::int32_t n) {
            if (reached[static_cast<std::size_t>(n)]) return;
            reached[static_cast<std::size_t>(n)] = true;
            open.push_back(n);
        };
        reach(group.nodes.front());
        for (const std::int32_t n : group.nodes) {
            if (group.pinned && pinned_[static_cast<std::size_t>(n)]) reach(n);
        }
        if (group.pinned && !pinned_[static_cast<std::size_t>(group.nodes.front())]) {
            reached[static_cast<std::size_t>(group.nodes.front())] = false;
            open.erase(open.begin());
        }
        for (std::size_t head = 0; head < open.size(); ++head) {
            for_links(open[head], [&](std::int32_t to, std::size_t) {
                if (std::binary_search(group.nodes.begin(), group.nodes.end(), to)) reach(to);
            });
        }
        return open.size() == group.nodes.size();
    }

    std::int32_t free_label() const {
        for (std::size_t l = 1; l < members_.size(); ++l) {
            if (members_[l].empty()) return static_cast<std::int32_t>(l);
        }
        return pinned_label;  // not reached: a group of two or more leaves a label free
    }

    template <class F>
    void for_links(std::int32_t n, F f) const {
        const auto i = static_cast<std::size_t>(n);
        for (std::size_t k = adjacency_.first[i]; k < adjacency_.first[i + 1]; ++k) {
            f(adjacency_.node[k], adjacency_.edge[k]);
        }
    }

    std::span<const Edge> edges_;
    const Adjacency& adjacency_;
    const std::vector<bool>& pinned_;
    Random random_;
    std::vector<std::int32_t> label_;
    std::vector<Group> members_;  // by label
    std::vector<double> energy_of_label_;
    double energy_ = 0;
    Proposal proposal_;
};

std::vector<std::int32_t> canonical(const std::vector<std::int32_t>& labels) {
    std::map<std::int32_t, std::int32_t> number{{pinned_label, -1}};
    std::vector<std::int32_t> out;
    std::int32_t next = 0;
    for (const std::int32_t l : labels) {
        const auto [at, fresh] = number.try_emplace(l, next);
        if (fresh) ++next;
        out.push_back(at->second);
    }
    return out;
}

}  // namespace

Partition swendsen_wang_cuts(std::int32_t nodes, std::span<const Edge> edges,
                             const std::vector<bool>& pinned, const GroupEnergies& energies,
                             const SwendsenWangOptions& options) {
    Partition best;
    best.joined.assign(edges.size(), 0.0);
    if (nodes == 0) return best;
    const Adjacency adjacency(nodes, edges);
    EnergyCache cache(energies);
    std::vector<Chain> chains;
    const Random root(options.seed);
    for (unsigned c = 0; c < std::max(1u, options.chains); ++c) {
        chains.emplace_back(nodes, edges, adjacency, pinned, root.split(c));
    }
    cache.fetch(chains[0].groups());
    for (Chain& chain : chains) chain.start(cache);
    best.energy = chains[0].energy();
    std::vector<std::int32_t> best_labels = chains[0].labels();

    std::vector<std::uint64_t> joined(edges.size(), 0);
    std::uint64_t samples = 0;
    const unsigned steps = options.anneal_steps + options.sample_steps;
    for (unsigned step = 0; step < steps; ++step) {
        if (options.cancelled && options.cancelled()) break;
        const bool annealing = step < options.anneal_steps;
        const double along = static_cast<double>(step) / options.anneal_steps;
        const double temperature =
            annealing ? options.first_temperature *
                            std::pow(options.last_temperature / options.first_temperature, along)
                      : options.sample_temperature;
        std::vector<GroupQuery> wanted;
        for (Chain& chain : chains) {
            const Proposal& p = chain.propose(cache, temperature);
            if (p.open) wanted.insert(wanted.end(), {p.from_after, p.to_after});
        }
        cache.fetch(wanted);
        for (Chain& chain : chains) {
            chain.decide(cache);
            // A margin, so that rounding in the running sum is not taken for an improvement.
            if (chain.energy() < best.energy - 1e-9) {
                best.energy = chain.energy();
                best_labels = chain.labels();
            }
            if (annealing) continue;
            ++samples;
            for (std::size_t e = 0; e < edges.size(); ++e) {
                joined[e] += chain.labels()[static_cast<std::size_t>(edges[e].a)] ==
                             chain.labels()[static_cast<std::size_t>(edges[e].b)];
            }
        }
        if (annealing) best.best_energy_curve.push_back(best.energy);
    }
    for (std::size_t e = 0; e < edges.size() && samples > 0; ++e) {
        best.joined[e] = static_cast<double>(joined[e]) / static_cast<double>(samples);
    }
    best.label = canonical(best_labels);
    best.energies_evaluated = cache.evaluated();
    return best;
}

}  // namespace topple::graph
